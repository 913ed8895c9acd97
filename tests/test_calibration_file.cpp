#include <opencv2/calib3d.hpp>

#include "calibration_files.hpp"
#include "data/calibrations/forms.hpp"
#include "geometry/lens_mapping.hpp"
#include "geometry/undistortion.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;
using dataset_files::real_data;

namespace {

/// The rig in all formats below a folder: values for --calibration.
std::map<std::string, std::string> write_all(const TemporaryFolder& folder) {
  const Rig rig;
  write_text(folder / "cam0.yaml", euroc_sensor(rig, false));
  write_text(folder / "cam1.yaml", euroc_sensor(rig, true));
  std::map<std::string, std::string> files = {{"euroc", (folder / "cam0.yaml") + "," + (folder / "cam1.yaml")}};
  for (const char* extrinsics : {"T_cn_cnm1", "T_cam_imu", "T_imu_cam", "both"}) {
    const std::string file = folder / (std::string("kalibr_") + extrinsics + ".yaml");
    write_text(file, "%YAML:1.0 # as OpenVINS has it\n" + kalibr_chain(rig, extrinsics));
    files[std::string("kalibr ") + extrinsics] = file;
  }
  write_opencv(rig, folder / "stereo.yml");
  write_opencv(rig, folder / "stereo.xml");
  write_opencv(rig, folder / "stereo.json");
  write_opencv(rig, folder / "intrinsics.yml", folder / "extrinsics.yml");
  files["opencv yml"] = folder / "stereo.yml";
  files["opencv xml"] = folder / "stereo.xml";
  files["opencv json"] = folder / "stereo.json";
  files["opencv two"] = (folder / "intrinsics.yml") + "," + (folder / "extrinsics.yml");
  const auto infos = ros_camera_infos(rig);
  write_text(folder / "left.yaml", infos.first);
  write_text(folder / "right.yaml", infos.second);
  files["ros"] = (folder / "left.yaml") + "," + (folder / "right.yaml");
  write_calibration(folder / "native.yaml", read_calibration(files["euroc"]));
  files["native"] = folder / "native.yaml";
  return files;
}

void check_same(const Lens& one, const Lens& other) {
  CHECK(one.model == other.model);
  CHECK(one.camera.matrix() == other.camera.matrix());
  CHECK(one.camera.width == other.camera.width);
  CHECK(one.parameters == other.parameters);
}

/// Writes a file with a part replaced and expects an error that names it.
struct Damage {
  std::string file, calibration;
  std::string good = read_text(file);

  void operator()(const std::string& from, const std::string& to, const std::string& found) const {
    INFO(from << " -> " << to);
    REQUIRE(good.find(from) != std::string::npos);
    write_text(file, std::string(good).replace(good.find(from), from.size(), to));
    CHECK_THROWS_AS(read_calibration(calibration), DataError);
    CHECK_THROWS_WITH(read_calibration(calibration), Contains(file) && Contains(found) && Contains("expected"));
    write_text(file, good);
  }
};

}  // namespace

TEST_CASE("calibration: every format gives the same rig, to the last bit") {
  const TemporaryFolder folder;
  const auto files = write_all(folder);
  const StereoCalibration expected = read_calibration(files.at("euroc"));
  CHECK(expected.format == "euroc");
  CHECK(expected.left.camera.fy == 457.296);
  CHECK(expected.right.parameters[3] == -3.555907e-5);
  const Eigen::Isometry3d exact = Rig().right_from_left();
  CHECK((expected.right_from_left.translation() - exact.translation()).norm() < 1e-9);
  CHECK(Eigen::AngleAxisd(expected.right_from_left.linear().transpose() * exact.linear()).angle() < 2e-9);
  REQUIRE(expected.body_from_left);
  CHECK((expected.body_from_left->matrix() - Rig().body_from_left.matrix()).norm() < 1e-14);
  for (const auto& [name, list] : files) {
    INFO(name);
    StereoCalibration read = read_calibration(list);
    CHECK(name.rfind(read.format, 0) == 0);
    CHECK((read.left.camera.width == 0) == (read.format == "opencv"));  // OpenCV's files hold no image size
    data::set_image_sizes(read, {752, 480}, {752, 480}, "the images");
    check_same(read.left, expected.left);
    check_same(read.right, expected.right);
    CHECK(read.right_from_left.matrix() == expected.right_from_left.matrix());
    // The native file gives the same rig.
    write_calibration(folder / "again.yaml", read);
    CHECK(read_calibration(folder / "again.yaml").right_from_left.matrix() == expected.right_from_left.matrix());
    CHECK(read_text(folder / "again.yaml") == read_text(files.at("native")));
  }
  const std::string native = read_text(files.at("native"));
  CHECK(std::count(native.begin(), native.end(), '\n') == 11);  // a comment and ten entries
  StereoCalibration mistaken = read_calibration(files.at("ros"));
  CHECK_THROWS_WITH(data::set_image_sizes(mistaken, {640, 480}, {752, 480}, "a.png, b.png"),
                    Contains("a.png") && Contains("640 x 480") && Contains("left.yaml"));
}

TEST_CASE("calibration: every lens model of Kalibr is read") {
  const TemporaryFolder folder;
  const std::string file = folder / "chain.yaml", good = kalibr_chain(Rig(), "T_cn_cnm1");
  const auto with = [&](const std::string& camera_model, const std::string& intrinsics, const std::string& distortion,
                        const std::string& coefficients) {
    std::string text = good;
    const auto put = [&](const std::string& key, const std::string& value) {
      for (std::size_t at = text.find("  " + key + ":"); at != std::string::npos;
           at = text.find("  " + key + ":", at + 1))
        text.replace(at, text.find('\n', at) - at, "  " + key + ": " + value);
    };
    put("camera_model", camera_model);
    put("intrinsics", intrinsics);
    put("distortion_model", distortion);
    put("distortion_coeffs", coefficients);
    write_text(file, text);
    return read_calibration(file).left;
  };
  const Lens fisheye =
      with("pinhole", "[190.9, 190.8, 254.9, 256.8]", "equidistant", "[0.003, 0.0007, -0.002, 0.0002]");
  CHECK(fisheye.model == LensModel::equidistant);
  CHECK(fisheye.parameters == std::vector<double>{0.003, 0.0007, -0.002, 0.0002});
  CHECK(with("pinhole", "[190.9, 190.8, 254.9, 256.8]", "fov", "[0.93]").model == LensModel::field_of_view);
  CHECK(with("pinhole", "[190.9, 190.8, 254.9, 256.8]", "none", "[]").is_pinhole());
  const Lens sphere = with("ds", "[-0.2, 0.6, 190.9, 190.8, 254.9, 256.8]", "none", "[]");
  CHECK(sphere.model == LensModel::double_sphere);
  CHECK(sphere.parameters == std::vector<double>{-0.2, 0.6});
  CHECK(sphere.camera.fx == 190.9);
  const Lens omni = with("omni", "[1.7, 690.9, 690.8, 254.9, 256.8]", "radtan", "[-0.1, 0.2, 0.001, 0.002]");
  CHECK(omni.model == LensModel::omnidirectional);
  CHECK(omni.parameters == std::vector<double>{1.7, -0.1, 0.2, 0.001, 0.002});
}

TEST_CASE("calibration: the native form takes every name of a lens model") {
  const TemporaryFolder folder;
  const auto lens = [&](const std::string& model, const std::string& coefficients) {
    std::string text;
    for (const char* side : {"left_", "right_"})
      text += side + ("model: " + model) + "\n" + side + "size: [752, 480]\n" + side +
              "intrinsics: [450, 460, 370, 240]\n" + side + "coefficients: [" + coefficients + "]\n";
    write_text(folder / "rig.yaml", text + "rotation: [0, 0, 0]\ntranslation: [-0.11, 0, 0]\n");
    const Lens read = read_calibration(folder / "rig.yaml").right;
    CHECK(numbers(read.parameters) == coefficients);
    return read.model;
  };
  for (const char* name : {"radtan", "radial-tangential", "plumb_bob", "rational_polynomial"})
    CHECK(lens(name, "-0.25, 0.0625, 0, 0") == LensModel::radial_tangential);
  for (const char* name : {"equidistant", "fisheye"}) CHECK(lens(name, "0.25, 0.0625, 0, 0") == LensModel::equidistant);
  CHECK(lens("fov", "0.75") == LensModel::field_of_view);
  for (const char* name : {"double-sphere", "ds"}) CHECK(lens(name, "-0.25, 0.5") == LensModel::double_sphere);
  CHECK(lens("eucm", "0.5, 1.25") == LensModel::extended_unified);
  CHECK(lens("omni", "1.5, -0.25, 0.0625, 0, 0") == LensModel::omnidirectional);
  CHECK_THROWS_WITH(lens("fish-eye", "0.75"), Contains("rig.yaml:1") && Contains("\"fish-eye\" for left_model"));
}

TEST_CASE("calibration: errors in a Kalibr chain name the file and the entry") {
  const TemporaryFolder folder;
  const std::string file = folder / "chain.yaml";
  write_text(file, kalibr_chain(Rig(), "both"));
  const Damage damage{file, file};
  damage("  intrinsics:", "  intrinsic:", "no entry cam0.intrinsics");
  damage("cam1:", "cam2:", "no entry cam1");
  damage("  distortion_model: radtan", "  distortion_model: wide", "\"wide\" for cam0.distortion_model");
  damage("  camera_model: pinhole", "  camera_model: wide", "\"wide\" for cam0.camera_model");
  damage("1.76187114e-05]", "1.76187114e-05, 0, 0]", "6 numbers for the lens model radtan");
  damage("367.215, 248.375", "367.215", "3 numbers for cam0.intrinsics");
  damage("458.654", "-458.654", "a focal length fx of -458.654");
  damage("457.296", "1e308", "(cam0.intrinsics): found a focal length fy of 1e+308");
  damage("456.134", "1e-300", "(cam1.intrinsics): found a focal length fy of 1e-300");
  damage("367.215", "1e308", "(cam0.intrinsics): found a principal point cx of 1e+308");
  damage("0.07451284", "1e308", "(cam1.distortion_coeffs): found a coefficient 1");
  damage("[752, 480]", "[752.5, 480]", "cam0.resolution of 752.5 x 480");
  damage("0, 0, 0, 1]", "0, 0, 0, 2]", "a last row other than 0 0 0 1 for cam0.T_cam_imu");
  damage("T_cn_cnm1:\n  - [", "T_cn_cnm1:\n  - [57.", "cam1.T_cn_cnm1");  // degrees instead of a rotation
  damage("  resolution", "  intrinsics: [1, 2, 3, 4]\n  resolution", "a second entry intrinsics");
  // The inverse transform: it contradicts the one via the IMU.
  const Rig rig;
  damage(kalibr_matrix("T_cn_cnm1", rig.right_from_left()), kalibr_matrix("T_cn_cnm1", rig.right_from_left().inverse()),
         "differs from the one via the IMU");

  write_text(file, kalibr_chain(rig, "none"));
  CHECK_THROWS_WITH(read_calibration(file), Contains(file) && Contains("neither cam1.T_cn_cnm1 nor T_cam_imu"));
  Rig swapped;
  std::swap(swapped.body_from_left, swapped.body_from_right);
  for (const char* extrinsics : {"T_cam_imu", "T_cn_cnm1", "T_imu_cam"}) {
    write_text(file, kalibr_chain(swapped, extrinsics));
    CHECK_THROWS_WITH(read_calibration(file), Contains(file) && Contains("on its left") && Contains("exchanged"));
  }
  Rig single;
  single.body_from_right = single.body_from_left;
  write_text(file, kalibr_chain(single, "T_imu_cam"));
  CHECK_THROWS_WITH(read_calibration(file), Contains(file) && Contains("a baseline above zero"));
}

TEST_CASE("calibration: errors in OpenCV's stereo files name the file and the matrix") {
  const TemporaryFolder folder;
  const std::string inside = folder / "intrinsics.yml", outside = folder / "extrinsics.yml",
                    both = inside + "," + outside;
  write_opencv(Rig(), inside, outside);
  const Damage intrinsics{inside, both}, extrinsics{outside, both};
  intrinsics("M1:", "N1:", "no entry M1");
  intrinsics("D2:", "D3:", "no entry D2");
  intrinsics("D2:", "M1:", "a second entry M1");
  intrinsics("   rows: 3\n   cols: 3", "   rows: 9\n   cols: 1", "a matrix of 9 x 1 for M1");
  intrinsics("   cols: 4", "   cols: 3", "D1");
  intrinsics("4.5865", "-4.5865", "a focal length fx of -458.65");
  intrinsics("---", "distortion_model: fov\n---", "distortion_model");
  extrinsics("R:", "Q:", "no entry R");
  extrinsics("T:", "S:", "no entry T");
  extrinsics("   rows: 3\n   cols: 1", "   rows: 1\n   cols: 2", "T");
  extrinsics("data: [ 9.99", "data: [ 5.99", "orthonormal");
  extrinsics("data: [ -1.1", "data: [ 1.1", "on its left");
  extrinsics("data: [ -1.1", "data: [ .Nan, -1.1", "T");
  intrinsics("!!opencv-matrix", "!!opencv-matrix [", "not YAML");
  // A rotation vector, in radians and in degrees.
  const auto with_vector = [&](const cv::Vec3d& vector) {
    cv::FileStorage storage(outside, cv::FileStorage::WRITE);
    storage << "R" << cv::Mat(vector) << "T" << cv::Mat(cv::Vec3d(-0.11, 0, 0));
  };
  with_vector({0.01, -0.02, 0.003});
  CHECK(Eigen::AngleAxisd(read_calibration(both).right_from_left.linear()).angle() ==
        Approx(Eigen::Vector3d(0.01, -0.02, 0.003).norm()));
  with_vector({1, -5, 0.3});
  CHECK_THROWS_WITH(read_calibration(both), Contains(outside + " (R)") && Contains("degrees"));
  // Fisheye where the file says so.
  write_opencv(Rig(), folder / "fisheye.yml");
  write_text(folder / "fisheye.yml",
             read_text(folder / "fisheye.yml") + "distortion_model: fisheye\nimage_width: 752\nimage_height: 480\n");
  const StereoCalibration fisheye = read_calibration(folder / "fisheye.yml");
  CHECK(fisheye.left.model == LensModel::equidistant);
  CHECK(fisheye.right.camera.width == 752);
}

TEST_CASE("calibration: errors in ROS, EuRoC and native files name the file and the entry") {
  const TemporaryFolder folder;
  const auto files = write_all(folder);
  const Damage ros{folder / "right.yaml", files.at("ros")}, ros_left{folder / "left.yaml", files.at("ros")};
  ros("projection_matrix:", "projection:", "no entry projection_matrix");
  ros("image_width: 752", "image_width: wide", "\"wide\"");
  ros("plumb_bob", "thin_prism", "\"thin_prism\" for distortion_model");
  ros("data: [457.", "data: [1, 457.", "10 numbers for camera_matrix.data");
  ros_left("camera_name: left", "camera_matrix: 1", "a second entry camera_matrix");
  CHECK_THROWS_WITH(read_calibration((folder / "right.yaml") + "," + (folder / "left.yaml")),
                    Contains("right.yaml") && Contains("exchanged"));
  CHECK_THROWS_WITH(read_calibration(folder / "left.yaml"), Contains("left.yaml") && Contains("of one camera"));
  CHECK_THROWS_WITH(read_calibration((folder / "left.yaml") + "," + (folder / "left.yaml")),
                    Contains("left.yaml") && Contains("a baseline above zero"));

  CHECK_THROWS_WITH(read_calibration(folder / "cam0.yaml"), Contains("cam0.yaml") && Contains("of one camera"));
  CHECK_THROWS_WITH(read_calibration((folder / "cam1.yaml") + "," + (folder / "cam0.yaml")), Contains("exchanged"));
  CHECK_THROWS_WITH(read_calibration((folder / "cam0.yaml") + "," + (folder / "left.yaml")), Contains("left.yaml"));

  const Damage native{folder / "native.yaml", files.at("native")};
  native("left_model: radtan", "left_model: thick", "\"thick\" for left_model");
  native("right_size: [752, 480]", "right_size: [752]", "1 numbers for right_size");
  native("translation:", "shift:", "no entry translation");
  native("translation: [-0.", "translation: [0.", "on its left");
  native("rotation: [", "rotation: [5.7, ", "4 numbers for rotation");
  CHECK_THROWS_WITH(read_calibration(folder / "absent.yaml"), Contains("absent.yaml"));
  write_text(folder / "other.yaml", "fx: 3\nfy: 4\n");
  CHECK_THROWS_WITH(read_calibration(folder / "other.yaml"), Contains("fx, fy") && Contains("Kalibr"));
  write_text(folder / "native.yaml", native.good.substr(0, native.good.find("rotation:")) +
                                         "rotation: [0.04, 0.2, 0]\ntranslation: [-0.1, 0, 0]\n");
  CHECK_NOTHROW(read_calibration(folder / "native.yaml"));
  write_text(folder / "native.yaml", native.good.substr(0, native.good.find("rotation:")) +
                                         "rotation: [0.4, 12, 0]\ntranslation: [-0.1, 0, 0]\n");
  CHECK_THROWS_WITH(read_calibration(folder / "native.yaml"), Contains("(rotation)") && Contains("degrees"));
}

TEST_CASE("calibration: real Kalibr files are read") {
  const std::string folder = real_data("calibrations"), flight = real_data("euroc_mh_01_easy");
  if (folder.empty() || flight.empty()) return;
  // EuRoC's calibration, written as a chain by OpenVINS.
  const StereoCalibration chain = read_calibration(folder + "/kalibr_euroc_mav.yaml"),
                          sensors =
                              read_calibration(flight + "/mav0/cam0/sensor.yaml," + flight + "/mav0/cam1/sensor.yaml");
  check_same(chain.left, sensors.left);
  check_same(chain.right, sensors.right);
  CHECK(chain.right_from_left.matrix() == sensors.right_from_left.matrix());
  struct Published {
    const char* file;
    double baseline;  // m, from the cameras' data sheets or the files' comments
    double widest;    // degrees, horizontal, of the pinhole view
  };
  for (const auto& [file, baseline, widest] :
       {Published{"/kalibr_tum_vi.yaml", 0.101, 107}, Published{"/kalibr_rs_t265.yaml", 0.064, 113},
        Published{"/kalibr_uzhfpv_indoor.yaml", 0.08, 98}}) {
    INFO(file);
    const StereoCalibration fisheye = read_calibration(folder + file);
    CHECK(fisheye.left.model == LensModel::equidistant);
    CHECK(fisheye.right_from_left.translation().norm() == Approx(baseline).epsilon(0.03));
    const StereoRig rig = make_rig(fisheye);
    CHECK_NOTHROW(check_rig(rig, file));
    CHECK(2 * std::atan(0.5 * rig.left.width / rig.left.fx) / kDegree == Approx(widest).margin(1));
  }
}

TEST_CASE("calibration: corners of OpenCV's chessboard pairs lie on their epipolar lines after undistortion") {
  const std::string folder = real_data("calibrations");
  if (folder.empty()) return;
  const std::string board = folder + "/opencv_chessboard/";
  StereoCalibration opencv = read_calibration(board + "intrinsics.yml," + board + "extrinsics.yml"),
                    ros = read_calibration(board + "ros_left.yaml," + board + "ros_right.yaml");
  data::set_image_sizes(opencv, {640, 480}, {640, 480}, "the images");
  check_same({opencv.left.model, opencv.left.camera, {}}, {ros.left.model, ros.left.camera, {}});
  CHECK((opencv.right_from_left.matrix() - ros.right_from_left.matrix()).cwiseAbs().maxCoeff() < 2e-9);
  const StereoRig rig = make_rig(opencv), other = make_rig(ros);
  CHECK(rig.left_undistortion.source_x.values() == other.left_undistortion.source_x.values());
  const Eigen::Matrix3d turn = rig.right_from_left.linear();
  const Eigen::Vector3d t = rig.right_from_left.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Eigen::Matrix3d fundamental =
      rig.right.matrix().inverse().transpose() * cross * turn * rig.left.matrix().inverse();
  std::vector<double> residuals;
  for (int pair = 1; pair <= 9; ++pair) {
    const auto corners = [&](const std::string& side, const UndistortionTable& table) {
      Image image = undistort(read_grey_image(board + side + "0" + std::to_string(pair) + ".jpg").view(), table);
      std::vector<cv::Point2f> found;
      cv::findChessboardCorners(cv::Mat(image.height, image.width, CV_8UC1, image.pixels.data()), {9, 6}, found);
      return found;
    };
    const auto left = corners("left", rig.left_undistortion), right = corners("right", rig.right_undistortion);
    if (left.size() != 54 || right.size() != 54) continue;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const Eigen::Vector3d line = fundamental * Eigen::Vector3d(left[i].x, left[i].y, 1);
      residuals.push_back(std::abs(line.dot(Eigen::Vector3d(right[i].x, right[i].y, 1))) / line.head<2>().norm());
    }
  }
  REQUIRE(residuals.size() >= 6 * 54);
  std::sort(residuals.begin(), residuals.end());
  INFO("median " << residuals[residuals.size() / 2] << " px of " << residuals.size() << " corners");
  CHECK(residuals[residuals.size() / 2] < 0.5);
}
