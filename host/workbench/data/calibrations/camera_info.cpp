/// \file camera_info.cpp  ROS camera_info of both cameras, from calibration files or as `rostopic echo` and `ros2 topic
/// echo` print it: the recording camera (K, D), the rotation that rectifies its images (R), and the rectified camera
/// (P, whose fourth column is -fx' times its distance from the reference camera).

#include <Eigen/Geometry>
#include <cmath>

#include "data/calibrations/forms.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

/// Names of the entries in files, in ROS 1 messages and in ROS 2 messages.
struct Names {
  const char *width, *height, *k, *d, *r, *p;
};
constexpr Names kNames[] = {
    {"image_width", "image_height", "camera_matrix", "distortion_coefficients", "rectification_matrix",
     "projection_matrix"},
    {"width", "height", "K", "D", "R", "P"},
    {"width", "height", "k", "d", "r", "p"},
};

/// Images that show a part of the sensor, or every n-th pixel, as ROS's image_geometry takes them.
void apply_roi_and_binning(const YamlMap& camera, PinholeCamera& lens) {
  if (camera.has("roi")) {
    const YamlMap roi = camera.map("roi");
    lens.cx -= roi.number_or("x_offset", 0);
    lens.cy -= roi.number_or("y_offset", 0);
    if (roi.number_or("width", 0) > 0) set_size(lens, roi.size("width", "height"));
  }
  const double columns = std::max(1.0, camera.number_or("binning_x", 1)),
               rows = std::max(1.0, camera.number_or("binning_y", 1));
  lens.fx /= columns;
  lens.cx /= columns;
  lens.fy /= rows;
  lens.cy /= rows;
  lens.width = static_cast<int>(lens.width / columns);
  lens.height = static_cast<int>(lens.height / rows);
}

StatedLens read_lens(const YamlMap& camera, const Names& names) {
  const ImageSize size = camera.size(names.width, names.height);
  // ROS itself takes plumb_bob for files of before it had other models.
  const std::string model = camera.has("distortion_model") ? camera.word("distortion_model") : "plumb_bob";
  StatedLens stated = read_matrix_lens(camera, names.k, names.d, size);
  Lens& lens = stated.lens;
  if (model == "none" || model.empty()) {
    for (const double coefficient : lens.parameters)
      if (coefficient != 0) camera.complain(names.d, "coefficients of the lens model " + in_quotes(model), "zeros");
    lens.parameters.clear();
  }
  lens.model = model_of_word(camera, "distortion_model", model);
  if (lens.model == LensModel::equidistant)
    while (lens.parameters.size() > 4 && lens.parameters.back() == 0) lens.parameters.pop_back();
  apply_roi_and_binning(camera, lens.camera);
  return stated;
}

Rectification read_rectification(const YamlMap& camera, const Names& names) {
  return {camera.rotation(names.r), projection_offset(camera, names.p)};
}

const Names& names_of(const YamlMap& camera) {
  return kNames[camera.has("camera_matrix") ? 0 : camera.has("K") ? 1 : 2];
}

/// Rotations from both cameras to images whose rows are epipolar lines, and the pinhole camera of these images. What is
/// on the optical axes stays where it is in the recorded images, on average.
struct RectifiedPair {
  Eigen::Matrix3d from_left, from_right;
  double focal = 0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
};

RectifiedPair rectify(const StereoCalibration& calibration) {
  const Eigen::Matrix3d left_from_right = calibration.right_from_left.linear().transpose();
  const Eigen::Vector3d baseline = -(left_from_right * calibration.right_from_left.translation());
  if (std::abs(baseline.x()) < std::abs(baseline.y()))
    throw UsageError("format ros: expected cameras beside one another, not one above the other");
  RectifiedPair pair;
  const Eigen::Vector3d x = baseline.normalized(),
                        y = (Eigen::Vector3d::UnitZ() + left_from_right.col(2)).cross(x).normalized();
  pair.from_left << x.transpose(), y.transpose(), x.cross(y).transpose();
  pair.from_right = pair.from_left * left_from_right;
  pair.focal = 0.5 * (calibration.left.camera.fy + calibration.right.camera.fy);
  const auto add = [&](const PinholeCamera& camera, const Eigen::Vector3d& axis) {
    pair.centre += 0.5 * (Eigen::Vector2d(camera.cx, camera.cy) - pair.focal * axis.hnormalized());
  };
  add(calibration.left.camera, pair.from_left.col(2));
  add(calibration.right.camera, pair.from_right.col(2));
  return pair;
}

std::string camera_info(const Lens& lens, Side side, const RectifiedPair& pair, double offset) {
  std::vector<double> coefficients = lens.parameters;
  std::string model = "equidistant";
  if (lens.model == LensModel::radial_tangential) {
    while (coefficients.size() > 8 && coefficients.back() == 0) coefficients.pop_back();
    model = coefficients.size() > 5 ? "rational_polynomial" : "plumb_bob";
    if (coefficients.size() < 5) coefficients.resize(5);
  }
  if (coefficients.size() > 8 || (lens.model != LensModel::radial_tangential && lens.model != LensModel::equidistant))
    refuse_lens("ros", lens, side, "equidistant, or radtan with at most k1 k2 p1 p2 k3 k4 k5 k6");
  const PinholeCamera& camera = lens.camera;
  const double f = pair.focal, x = pair.centre.x(), y = pair.centre.y();
  return "image_width: " + std::to_string(camera.width) + "\nimage_height: " + std::to_string(camera.height) +
         "\ncamera_name: " + (side == Side::left ? "left" : "right") + "\n" +
         matrix_lines("camera_matrix", 3, row_major(camera.matrix())) + "distortion_model: " + model + "\n" +
         matrix_lines("distortion_coefficients", 1, coefficients) +
         matrix_lines("rectification_matrix", 3, row_major(side == Side::left ? pair.from_left : pair.from_right)) +
         matrix_lines("projection_matrix", 3, {f, 0, x, f * offset, 0, f, y, 0, 0, 0, 1, 0});
}

std::vector<std::string> write_camera_infos(const StereoCalibration& calibration) {
  const RectifiedPair pair = rectify(calibration);
  return {camera_info(calibration.left, Side::left, pair, 0),
          camera_info(calibration.right, Side::right, pair, -calibration.right_from_left.translation().norm())};
}

}  // namespace

LensModel model_of_word(const YamlMap& camera, const std::string& key, const std::string& word) {
  for (const char* name : {"plumb_bob", "rational_polynomial", "radtan", "radial-tangential", "none", ""})
    if (word == name) return LensModel::radial_tangential;
  if (word == "equidistant" || word == "fisheye") return LensModel::equidistant;
  camera.complain(key, in_quotes(word), "plumb_bob, rational_polynomial, equidistant or none");
}

namespace {

StatedCalibration read_pair(const YamlMap& left, const YamlMap& right) {
  const Names &left_names = names_of(left), &right_names = names_of(right);
  const Rectification of_left = read_rectification(left, left_names), of_right = read_rectification(right, right_names);
  const double offset = of_right.rectified_from_reference.x() - of_left.rectified_from_reference.x();
  if (offset > 0 && left.file() == right.file()) return read_pair(right, left);  // in no order
  if (of_left.rectified_from_reference.isZero() && of_right.rectified_from_reference.isZero())
    fail(right.file(), "a fourth column of zeros in " + std::string(right_names.p) + " as in the left camera's",
         "a baseline above zero, -fx' times it there: were the cameras calibrated one by one?");
  StatedCalibration stated;
  stated.left = read_lens(left, left_names);
  stated.right = read_lens(right, right_names);
  stated.right_from_left = right_from_left_of(of_left, of_right);
  StatedCalibration rectified =
      rectified_cameras(left, left_names.p, left.size(left_names.width, left_names.height), right, right_names.p,
                        right.size(right_names.width, right_names.height));
  apply_roi_and_binning(left, rectified.left.lens.camera);
  apply_roi_and_binning(right, rectified.right.lens.camera);
  stated.of_rectified.push_back(std::move(rectified));
  return stated;
}

StatedCalibration read_camera_infos(const std::vector<CalibrationText>& texts) {
  return read_pair(texts[0].entries(), texts[1].entries());
}

bool is_camera_infos(const CalibrationText& text) {
  return (text.has("camera_matrix") && (text.has("projection_matrix") || text.has("image_width"))) ||
         (text.has("K") && text.has("P")) || (text.has("k") && text.has("p"));
}

}  // namespace

const CalibrationForm kCameraInfos{
    "ros",
    "ROS camera_info, as files or as `rostopic echo` prints it (camera_matrix or K, D, R, P)",
    true,
    is_camera_infos,
    read_camera_infos,
    write_camera_infos};

}  // namespace quadedge::data
