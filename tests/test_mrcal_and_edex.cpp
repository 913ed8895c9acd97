#include "calibration_files.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;

namespace {

/// A camera as mrcal writes it, with a note, the older name of the pose, and the data of the calibration in base 85.
std::string mrcal_camera(const std::string& model, const std::string& intrinsics, const std::string& pose) {
  return "# generated with {it's a test: [1}\n{\n    'lensmodel':  '" + model +
         "',\n\n    # intrinsics are fx,fy,cx,cy,distortion0,distortion1,....\n    'intrinsics': [ " + intrinsics +
         ",],\n\n    'valid_intrinsics_region': [\n    [ 0, 0 ],\n    [ 751, 0 ],\n],\n\n    'rt_cam_ref': [ " + pose +
         ",],\n    'extrinsics': [ " + pose +
         ",], # for compatibility\n\n    'imagersize': [ 752, 480,],\n\n    'icam_intrinsics': 0,\n\n"
         "    'optimization_inputs': b'P)h>@6aWAK2mk;8{A}#p&r(8*b',\n\n}\n";
}

constexpr const char* kPinhole = "450, 460, 370, 240";
constexpr const char* kBrown = "450, 460, 370, 240, -0.25, 0.0625, 0.001, -0.002";
constexpr const char* kAtReference = "0, 0, 0, 0, 0, 0";
constexpr const char* kOnTheRight = "0, 0, 0, -0.11, 0, 0";

/// Both cameras of mrcal in a folder, as a value for --calibration.
std::string write_mrcal(const TemporaryFolder& folder, const std::string& left, const std::string& right) {
  write_text(folder / "left.cameramodel", left);
  write_text(folder / "right.cameramodel", right);
  return (folder / "left.cameramodel") + "," + (folder / "right.cameramodel");
}

std::string edex_camera(const std::string& model, const std::string& coefficients, const std::string& transform) {
  return "{\"intrinsics\": {\"distortion_model\": \"" + model + "\",\n\"distortion_params\": [" + coefficients +
         "],\n\"focal\": [450, 460], \"principal\": [370, 240], \"size\": [752, 480]},\n\"transform\": [" + transform +
         "]}";
}

std::string edex(const std::string& cameras, const std::string& header = "\"version\": \"0.9\"") {
  return "[\n\t{" + header + ", \"frame_start\": 0, \"frame_end\": 9,\n\"cameras\": [" + cameras +
         "]},\n{\"fps\": 20, \"sequence\": [[\"00/0.png\"], [\"01/0.png\"]]}\n]\n";
}

constexpr const char* kIdentity = "[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]";
constexpr const char* kShifted = "[1, 0, 0, 0.11], [0, 1, 0, 0], [0, 0, 1, 0]";

/// Writes an EDEX file and reads it.
StereoCalibration read_edex_text(const TemporaryFolder& folder, const std::string& text) {
  write_text(folder / "stereo.edex", text);
  return read_calibration(folder / "stereo.edex");
}

void check_transform(const StereoCalibration& calibration, const Eigen::Matrix3d& rotation,
                     const Eigen::Vector3d& translation) {
  CHECK((calibration.right_from_left.linear() - rotation).cwiseAbs().maxCoeff() < 3e-9);
  CHECK((calibration.right_from_left.translation() - translation).cwiseAbs().maxCoeff() < 3e-9);
}

}  // namespace

TEST_CASE("calibration forms: mrcal's cameras refer to a common frame") {
  const TemporaryFolder folder;
  // The left camera is turned by 90 degrees about z: R t_left = (2, -1, 3) for R = (0 1 0; -1 0 0; 0 0 1).
  const StereoCalibration read = read_calibration(
      write_mrcal(folder, mrcal_camera("LENSMODEL_OPENCV4", kBrown, "0, 0, 1.5707963267948966, 1., 2, 3e0"),
                  mrcal_camera("LENSMODEL_PINHOLE", kPinhole, "0, 0, 0, 1.9, -.998, 3.003")));
  CHECK(read.format == "mrcal");
  check_transform(read, (Eigen::Matrix3d() << 0, 1, 0, -1, 0, 0, 0, 0, 1).finished(), {-0.1, 0.002, 0.003});
  CHECK(read.left.model == LensModel::radial_tangential);
  CHECK(read.left.parameters == std::vector<double>{-0.25, 0.0625, 0.001, -0.002});
  CHECK(read.left.camera.matrix() == PinholeCamera{450, 460, 370, 240, 0, 0}.matrix());
  CHECK(read.left.camera.width == 752);
  CHECK(read.left.camera.height == 480);
  CHECK(read.right.is_pinhole());
  CHECK(read.right.parameters.empty());
  CHECK_FALSE(read.body_from_left);
}

TEST_CASE("calibration forms: the models of mrcal with OpenCV's coefficients") {
  const TemporaryFolder folder;
  for (const std::size_t count : {4U, 5U, 8U, 12U}) {
    std::vector<double> coefficients;
    for (std::size_t i = 0; i < count; ++i) coefficients.push_back(0.001 * (1.0 + static_cast<double>(i)));
    const std::string model = "LENSMODEL_OPENCV" + std::to_string(count),
                      intrinsics = std::string(kPinhole) + ", " + numbers(coefficients);
    const StereoCalibration read = read_calibration(write_mrcal(folder, mrcal_camera(model, intrinsics, kAtReference),
                                                                mrcal_camera(model, intrinsics, kOnTheRight)));
    CHECK(read.left.model == LensModel::radial_tangential);
    CHECK(read.left.parameters == coefficients);
    CHECK_THROWS_WITH(read_calibration(write_mrcal(folder, mrcal_camera(model, kPinhole, kAtReference),
                                                   mrcal_camera(model, intrinsics, kOnTheRight))),
                      Contains("left.cameramodel") && Contains("4 numbers for intrinsics") &&
                          Contains(std::to_string(4 + count) + " numbers"));
  }
}

TEST_CASE("calibration forms: mrcal's files by hand: other names, brackets, quotes") {
  const TemporaryFolder folder;
  const std::string older =
      "{ \"lensmodel\": 'LENSMODEL_PINHOLE', 'intrinsics': (450, 460, 370, 240),\n\t'imagersize': "
      "(752,\n480),# no space\n'extrinsics': ";
  check_transform(read_calibration(write_mrcal(folder, older + "(0, 0, 0, 0, 0, 0) }", older + "[0,0,0,-0.11,0,0],}")),
                  Eigen::Matrix3d::Identity(), {-0.11, 0, 0});
  std::string both = mrcal_camera("LENSMODEL_PINHOLE", kPinhole, kOnTheRight);
  const std::string good = both, left = mrcal_camera("LENSMODEL_PINHOLE", kPinhole, kAtReference);
  both.replace(both.find("'extrinsics': [ 0"), 17, "'extrinsics': [ 1");
  CHECK_THROWS_WITH(read_calibration(write_mrcal(folder, left, both)),
                    Contains("right.cameramodel:14") && Contains("rt_cam_ref") && Contains("expected"));
  CHECK_THROWS_WITH(read_calibration(write_mrcal(folder, left, good.substr(0, good.find("'imagersize'")))),
                    Contains("right.cameramodel") && Contains("is not YAML"));
  CHECK_THROWS_WITH(
      read_calibration(write_mrcal(folder, left,
                                   good.substr(0, good.find("'rt_cam_ref'")) + good.substr(good.find("'imagersize'")))),
      Contains("right.cameramodel") && Contains("no entry rt_cam_ref"));
}

TEST_CASE("calibration forms: mrcal's files that are no stereo pair are refused") {
  const TemporaryFolder folder;
  const std::string left = mrcal_camera("LENSMODEL_PINHOLE", kPinhole, kAtReference),
                    right = mrcal_camera("LENSMODEL_PINHOLE", kPinhole, kOnTheRight);
  const std::string files = write_mrcal(folder, left, right);
  check_transform(read_calibration(files), Eigen::Matrix3d::Identity(), {-0.11, 0, 0});
  CHECK_THROWS_WITH(read_calibration(folder / "left.cameramodel"),
                    Contains("left.cameramodel") && Contains("of one camera") && Contains("LEFT,RIGHT"));
  CHECK_THROWS_WITH(read_calibration(write_mrcal(folder, left, left)),
                    Contains("a baseline above zero") && Contains("one by one"));
  CHECK_THROWS_WITH(read_calibration(write_mrcal(folder, right, left)), Contains("exchanged"));
  CHECK_THROWS_WITH(
      read_calibration(write_mrcal(
          folder, left, mrcal_camera("LENSMODEL_PINHOLE", kPinhole, "0, 1.5707963267948966, 0, -0.11, 0, 0"))),
      Contains("right.cameramodel") && Contains("90 degrees apart") && Contains("the same direction"));
  for (const char* model : {"LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=30_Ny=20_fov_x_deg=170", "LENSMODEL_CAHVORE",
                            "LENSMODEL_STEREOGRAPHIC"})
    CHECK_THROWS_WITH(read_calibration(write_mrcal(folder, left, mrcal_camera(model, kPinhole, kOnTheRight))),
                      Contains("right.cameramodel:3") && Contains(std::string(model).substr(0, 17)) &&
                          Contains("OPENCV12") && Contains("mrcal-convert-lensmodel"));
}

TEST_CASE("calibration forms: EDEX has y up and z backward, and poses of the cameras in the rig") {
  const TemporaryFolder folder;
  // In the left camera's frame the right one is at (0.1, 0.02, -0.03): up by 2 cm and 3 cm ahead, which is
  // (0.1, -0.02, 0.03) with y down and z forward. It is turned about the y axis, which points up, by the angle with
  // cosine 0.8 and sine 0.6, which is the opposite angle about an axis that points down. The left one is turned by 90
  // degrees about z in the rig.
  const StereoCalibration read = read_edex_text(
      folder, edex(edex_camera("pinhole", "", "[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3]") + ", " +
                   edex_camera("pinhole", "", "[0, -1, 0, 0.98], [0.8, 0, 0.6, 2.1], [-0.6, 0, 0.8, 2.97]")));
  CHECK(read.format == "edex");
  const Eigen::Matrix3d left_from_right = (Eigen::Matrix3d() << 0.8, 0, -0.6, 0, 1, 0, 0.6, 0, 0.8).finished();
  check_transform(read, left_from_right.transpose(), {-0.8 * 0.1 - 0.6 * 0.03, 0.02, 0.6 * 0.1 - 0.8 * 0.03});
  CHECK(read.left.is_pinhole());
  CHECK(read.left.camera.matrix() == PinholeCamera{450, 460, 370, 240, 0, 0}.matrix());
  CHECK(read.right.camera.width == 752);
  CHECK(read.right.camera.height == 480);
  // As 4 x 4 matrices, with a third camera behind them.
  const std::string last = ", [0, 0, 0, 1]", third = ", " + edex_camera("pinhole", "", kIdentity);
  check_transform(read_edex_text(folder, edex(edex_camera("pinhole", "", kIdentity + last) + ", " +
                                              edex_camera("pinhole", "", kShifted + last) + third)),
                  Eigen::Matrix3d::Identity(), {-0.11, 0, 0});
}

TEST_CASE("calibration forms: the lens models of EDEX") {
  const TemporaryFolder folder;
  const auto lens = [&](const std::string& model, const std::string& coefficients) {
    return read_edex_text(
               folder, edex(edex_camera(model, coefficients, kIdentity) + ", " + edex_camera("pinhole", "", kShifted)))
        .left;
  };
  for (const char* name : {"fisheye", "fisheye4"}) {
    CHECK(lens(name, "0.1, 0.2, 0.3, 0.4").model == LensModel::equidistant);
    CHECK(lens(name, "0.1, 0.2, 0.3, 0.4").parameters == std::vector<double>{0.1, 0.2, 0.3, 0.4});
  }
  for (const char* name : {"brown5k", "brown"}) {  // k1 k2 k3 p1 p2
    CHECK(lens(name, "0.1, 0.2, 0.3, 0.004, 0.005").model == LensModel::radial_tangential);
    CHECK(lens(name, "0.1, 0.2, 0.3, 0.004, 0.005").parameters == std::vector<double>{0.1, 0.2, 0.004, 0.005, 0.3});
  }
  CHECK(lens("polynomial", "1, 2, 0.003, 0.004, 5, 6, 7, 8").model == LensModel::radial_tangential);
  CHECK(lens("polynomial", "1, 2, 0.003, 0.004, 5, 6, 7, 8").parameters ==
        std::vector<double>{1, 2, 0.003, 0.004, 5, 6, 7, 8});
  std::string bare = edex_camera("pinhole", "", kIdentity);  // as dumps have it
  bare.erase(bare.find("\"distortion_params\": [],"), 24);
  CHECK(read_edex_text(folder, edex(bare + ", " + edex_camera("pinhole", "", kShifted))).left.is_pinhole());
  CHECK_THROWS_WITH(lens("polynomial", "1, 2, 3, 4, 5"),
                    Contains("stereo.edex:4") && Contains("5 numbers for cameras[0].intrinsics.distortion_params") &&
                        Contains("[8 numbers]"));
  CHECK_THROWS_WITH(lens("pinhole", "0.1"), Contains("1 numbers") && Contains("[0 numbers]"));
  CHECK_THROWS_WITH(lens("rational", "0.1"), Contains("stereo.edex:3") && Contains("\"rational\"") &&
                                                 Contains("distortion_model") && Contains("brown5k"));
}

TEST_CASE("calibration forms: EDEX without a stereo pair, or of unknown axes, is refused") {
  const TemporaryFolder folder;
  const std::string left = edex_camera("pinhole", "", kIdentity), right = edex_camera("pinhole", "", kShifted);
  const auto read = [&](const std::string& text) { return read_edex_text(folder, text); };
  CHECK_THROWS_AS(read(edex(left)), DataError);
  CHECK_THROWS_WITH(read(edex(left)),
                    Contains("stereo.edex:3") && Contains("1 camera for cameras") && Contains("two, left and right"));
  CHECK_THROWS_WITH(read(edex("")), Contains("0 cameras"));
  CHECK_THROWS_WITH(read(edex(left + ", " + left)), Contains("stereo.edex") && Contains("a baseline above zero"));
  CHECK_THROWS_WITH(read(edex(right + ", " + left)), Contains("exchanged"));
  const std::string backward = edex_camera("pinhole", "", "[-1, 0, 0, 0.11], [0, 1, 0, 0], [0, 0, -1, 0]");
  CHECK_THROWS_WITH(read(edex(left + ", " + backward)), Contains("stereo.edex") && Contains("180 degrees apart"));
  std::string no_pose = right;
  no_pose.replace(no_pose.find("transform"), 9, "pose");
  CHECK_THROWS_WITH(read(edex(left + ", " + no_pose)), Contains("no entry cameras[1].transform"));
  CHECK_THROWS_WITH(read(edex(left + ", " + edex_camera("pinhole", "", "[2, 0, 0, 0.11], [0, 1, 0, 0], [0, 0, 1, 0]"))),
                    Contains("cameras[1].transform") && Contains("orthonormal"));
  CHECK_THROWS_WITH(read(edex("{\"name\": \"cam0\"}, " + right)), Contains("no entry cameras[0].intrinsics"));
  CHECK_THROWS_WITH(read(edex(left + ", " + right).substr(0, 250)),
                    Contains("stereo.edex") && Contains("is not YAML") && Contains("EDEX"));
  CHECK_THROWS_WITH(read("[[\"cameras\"]]"), Contains("stereo.edex") && Contains("no entries"));
  CHECK_THROWS_WITH(read("[]"), Contains("one of these formats") && Contains("EDEX") && Contains("mrcal"));
  const std::string twice = "\"version\": \"0.9\", \"version\": \"0.9\"";
  CHECK_THROWS_WITH(read(edex(left + ", " + right, twice)), Contains("a second entry version"));
  // Dumps state the axes of the interface, which changed; where both give the same, they are read.
  const std::string dump = "\"cuvslam_version_major\": 15",
                    higher = edex_camera("pinhole", "", "[1, 0, 0, 0.11], [0, 1, 0, 0.01], [0, 0, 1, 0]");
  check_transform(read(edex(left + ", " + right, dump)), Eigen::Matrix3d::Identity(), {-0.11, 0, 0});
  CHECK_THROWS_WITH(read(edex(left + ", " + higher, dump)), Contains("stereo.edex:2") && Contains("dump of cuVSLAM"));
  check_transform(read(edex(left + ", " + higher)), Eigen::Matrix3d::Identity(), {-0.11, 0.01, 0});
}
