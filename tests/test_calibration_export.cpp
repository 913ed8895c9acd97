#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include "data/yaml_file.hpp"
#include "dataset_files.hpp"
#include "program.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

StereoCalibration calibration_of(LensModel model, const std::vector<double>& left, const std::vector<double>& right) {
  StereoCalibration calibration;
  calibration.left = {model, {310.25, 311.5, 322.125, 238.75, 640, 480}, left};
  calibration.right = {model, {309.5, 310.75, 318.5, 241.25, 640, 480}, right};
  calibration.right_from_left = Eigen::Translation3d(-0.123456789, 0.001, -0.002) *
                                Eigen::AngleAxisd(0.05, Eigen::Vector3d(0.3, 1, -0.2).normalized());
  return calibration;
}

bool is_same_lens(const Lens& one, const Lens& other, std::vector<double> expected) {
  expected.resize(std::max(expected.size(), one.parameters.size()));  // zeros for coefficients that a format demands
  const PinholeCamera &a = one.camera, &b = other.camera;
  return one.model == other.model && one.parameters == expected && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx &&
         a.cy == b.cy && a.width == b.width && a.height == b.height;
}

}  // namespace

TEST_CASE("calibration export: every format gives back the rig that was written") {
  const TemporaryFolder folder;
  struct Case {
    LensModel model;
    std::vector<double> left, right;
    Words formats;
  };
  const std::vector<Case> cases = {
      {LensModel::radial_tangential, {}, {}, {"native", "kalibr", "opencv", "ros"}},
      {LensModel::radial_tangential,
       {-0.28, 0.07, 1.9e-4, 1.8e-5},
       {-0.27, 0.06, -1e-4, 3e-5},
       {"native", "kalibr", "opencv", "ros"}},
      {LensModel::radial_tangential,
       {-0.35, 0.17, 2e-3, 1e-3, -0.05},
       {-0.34, 0.16, 1e-3, 7e-4, -0.06},
       {"native", "opencv", "ros"}},
      {LensModel::radial_tangential,
       {0.3, 0.2, 1e-4, 1e-4, 0.01, 0.4, 0.1, 0.02},
       {0.2, 0.1, 1e-4, 1e-4, 0.02, 0.3, 0.2, 0.01},
       {"native", "opencv", "ros"}},
      {LensModel::equidistant,
       {-0.013, 0.02, -0.012, 0.002},
       {-0.012, 0.03, -0.011, 0.003},
       {"native", "kalibr", "opencv", "ros"}},
      {LensModel::field_of_view, {0.9}, {0.91}, {"native", "kalibr"}},
      {LensModel::double_sphere, {-0.2, 0.55}, {-0.21, 0.56}, {"native", "kalibr"}},
      {LensModel::extended_unified, {0.6, 1.1}, {0.61, 1.2}, {"native", "kalibr"}},
      {LensModel::omnidirectional, {1.2}, {1.3}, {"native", "kalibr"}},
      {LensModel::omnidirectional, {1.2, -0.1, 0.02, 1e-4, 2e-4}, {1.3, -0.2, 0.03, 3e-4, 1e-4}, {"native", "kalibr"}},
  };
  for (const Case& each : cases) {
    const StereoCalibration given = calibration_of(each.model, each.left, each.right);
    for (const std::string& format : calibration_formats()) {
      INFO(to_string(each.model) << " with " << each.left.size() << " parameters as " << format);
      const std::string file = folder / "calibration.yaml",
                        files = format == "ros" ? (folder / "l.yaml") + "," + (folder / "r.yaml") : file;
      if (std::find(each.formats.begin(), each.formats.end(), format) == each.formats.end()) {
        CHECK_THROWS_AS(write_calibration(files, given, format), UsageError);
        continue;
      }
      write_calibration(files, given, format);
      const StereoCalibration read = read_calibration(files);
      CHECK(read.format == format);
      CHECK(is_same_lens(read.left, given.left, each.left));
      CHECK(is_same_lens(read.right, given.right, each.right));
      CHECK((read.right_from_left.matrix() - given.right_from_left.matrix()).cwiseAbs().maxCoeff() < 2e-9);
    }
  }
}

TEST_CASE("calibration export: OpenCV reads the matrices, and ROS's R and P rectify") {
  const TemporaryFolder folder;
  const StereoCalibration given =
      calibration_of(LensModel::radial_tangential, {-0.35, 0.17, 2e-3, 1e-3, -0.05}, {-0.34, 0.16, 1e-3, 7e-4, -0.06});
  write_calibration(folder / "stereo.yml", given, "opencv");
  const cv::FileStorage storage(folder / "stereo.yml", cv::FileStorage::READ);
  cv::Mat m2, d1, rotation, translation;
  storage["M2"] >> m2;
  storage["D1"] >> d1;
  storage["R"] >> rotation;
  storage["T"] >> translation;
  CHECK(static_cast<int>(storage["image_width"]) == 640);
  CHECK(m2.at<double>(1, 2) == 241.25);
  CHECK((d1.rows == 1 && d1.cols == 5 && d1.at<double>(0, 4) == -0.05));
  CHECK(rotation.at<double>(0, 2) == given.right_from_left.linear()(0, 2));
  CHECK(translation.at<double>(0) == -0.123456789);

  write_calibration((folder / "l.yaml") + "," + (folder / "r.yaml"), given, "ros");
  const data::YamlMap left(folder / "l.yaml", "camera_info"), right(folder / "r.yaml", "camera_info");
  const Eigen::Matrix3d left_turn = left.rotation("rectification_matrix"),
                        right_turn = right.rotation("rectification_matrix");
  const auto p1 = left.matrix("projection_matrix", 3, 4), p2 = right.matrix("projection_matrix", 3, 4);
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0.5, -0.3, 2), Eigen::Vector3d(-4, 1, 9)}) {
    const Eigen::Vector3d in_left = left_turn * point, in_right = right_turn * (given.right_from_left * point);
    const double row = p1[5] * in_left.y() / in_left.z() + p1[6], column = p1[0] * in_left.x() / in_left.z() + p1[2];
    CHECK(p2[5] * in_right.y() / in_right.z() + p2[6] == Approx(row).margin(1e-6));
    // The right camera's image of the point is also P2 times the point as the rectified left camera sees it.
    CHECK(p2[0] * in_right.x() / in_right.z() + p2[2] == Approx(column + p2[3] / in_left.z()).margin(1e-6));
  }
  CHECK(p2[3] == Approx(-p2[0] * given.right_from_left.translation().norm()));
}

TEST_CASE("calibration export: what a format cannot hold is refused") {
  const TemporaryFolder folder;
  const StereoCalibration with_k3 =
      calibration_of(LensModel::radial_tangential, {-0.35, 0.17, 2e-3, 1e-3, -0.05}, {-0.3, 0.1, 0, 0, 0});
  CHECK_THROWS_WITH(write_calibration(folder / "k.yaml", with_k3, "kalibr"),
                    Contains("left lens is radtan with 5 parameters") && Contains("k1 k2 p1 p2"));
  StereoCalibration mixed = with_k3;
  mixed.right.model = LensModel::double_sphere;
  mixed.right.parameters = {-0.2, 0.5};
  CHECK_THROWS_WITH(write_calibration(folder / "k.yaml", mixed, "opencv"), Contains("right lens is double-sphere"));
  mixed = with_k3;
  mixed.right.camera.width = 320;
  CHECK_THROWS_WITH(write_calibration(folder / "k.yaml", mixed, "opencv"), Contains("one size"));
  mixed = with_k3;
  mixed.right_from_left.translation() = Eigen::Vector3d(0.001, -0.1, 0);
  CHECK_THROWS_WITH(write_calibration((folder / "l.yaml") + "," + (folder / "r.yaml"), mixed, "ros"),
                    Contains("beside one another"));
  CHECK_THROWS_WITH(write_calibration(folder / "k.yaml", with_k3, "ros"), Contains("two files"));
  CHECK_THROWS_WITH(write_calibration(folder / "k.yaml", with_k3, "matlab"),
                    Contains("matlab") && Contains("kalibr") && Contains("native"));
  CHECK_FALSE(std::filesystem::exists(folder / "k.yaml"));
}

TEST_CASE("cli: check and calibrate write calibrations for other programs", "[cli]") {
  const TemporaryFolder folder;
  const std::string both = (folder / "left.yaml") + "," + (folder / "right.yaml");
  const Words check = {"check",    small_sequence(),      "--quiet",  "--write-calibration", folder / "own.yaml",
                       "--kalibr", folder / "chain.yaml", "--opencv", folder / "stereo.yml", "--ros",
                       both};
  run_well(check);
  check_error(check, 2);  // without --force
  for (const std::string& files : {folder / "chain.yaml", folder / "stereo.yml", both}) {
    run_well({"check", small_sequence(), "--quiet", "--calibration", files});
    CHECK(read_calibration(files).right_from_left.matrix() ==
          read_calibration(folder / "own.yaml").right_from_left.matrix());
  }
  // A lens that a format cannot hold is refused after all else has been said and written.
  std::string text = read_text(folder / "own.yaml");
  for (const std::string side : {"left_", "right_"}) {
    text.replace(text.find(side + "model: radtan"), side.size() + 13, side + "model: fov");
    text.replace(text.find(side + "coefficients: []"), side.size() + 16, side + "coefficients: [0.1]");
  }
  write_text(folder / "fov.yaml", text);
  const auto refused = check_error({"check", small_sequence(), "--calibration", folder / "fov.yaml", "--opencv",
                                    folder / "fov.yml", "--kalibr", folder / "fov_chain.yaml"},
                                   2, {"fov.yml: format opencv: the left lens is fov with 1 parameter"});
  CHECK_THAT(refused.out, Contains(" errors, "));
  CHECK(read_calibration(folder / "fov_chain.yaml").left.model == LensModel::field_of_view);
  check_error({"check", small_sequence(), "--opencv", folder / "a.yaml", "--ros",
               (folder / "a.yaml") + "," + (folder / "b.yaml")},
              2);
  check_error({"calibrate", small_sequence(), "--ros", folder / "one.yaml"}, 2, {"LEFT,RIGHT"});
  run_well({"calibrate", small_sequence(), "--quiet", "-o", folder / "rig.yaml", "--opencv", folder / "learned.yml"});
  CHECK(read_calibration(folder / "learned.yml").left.camera.fx ==
        read_calibration(folder / "rig.yaml").left.camera.fx);
}
