/// \file camera_info.cpp  ROS camera_info of both cameras, from calibration files or as `rostopic echo` and `ros2 topic
/// echo` print it: the recording camera (K, D), the rotation that rectifies its images (R), and the rectified camera
/// (P, whose fourth column is -fx' times its distance from the reference camera).

#include "data/calibrations/forms.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

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
    if (roi.number_or("width", 0) > 0) {
      const ImageSize size = roi.size("width", "height");
      lens.width = size.width;
      lens.height = size.height;
    }
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

}  // namespace

LensModel model_of_word(const YamlMap& camera, const std::string& key, const std::string& word) {
  for (const char* name : {"plumb_bob", "rational_polynomial", "radtan", "radial-tangential", "none", ""})
    if (word == name) return LensModel::radial_tangential;
  if (word == "equidistant" || word == "fisheye") return LensModel::equidistant;
  camera.complain(key, in_quotes(word), "plumb_bob, rational_polynomial, equidistant or none");
}

StatedCalibration read_camera_infos(const YamlMap& left, const YamlMap& right) {
  const Names &left_names = names_of(left), &right_names = names_of(right);
  const Rectification of_left = read_rectification(left, left_names), of_right = read_rectification(right, right_names);
  const double offset = of_right.rectified_from_reference.x() - of_left.rectified_from_reference.x();
  if (offset > 0 && left.file() == right.file()) return read_camera_infos(right, left);  // in no order
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

}  // namespace quadedge::data
