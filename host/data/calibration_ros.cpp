/// \file calibration_ros.cpp  ROS camera_info files of a stereo pair: the recording camera (camera_matrix, distortion),
/// the rotation that rectifies it (rectification_matrix), and the rectified camera (projection_matrix, whose fourth
/// column is -fx' baseline).

#include "data/calibration_formats.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

struct CameraInfo {
  Lens lens;
  Eigen::Matrix3d rectified_from_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d rectified_from_left_rectified = Eigen::Vector3d::Zero();  ///< m
};

/// Values of "NAME: {rows, cols, data: [...]}".
std::vector<double> matrix_of(const YamlMap& camera, const std::string& key, std::size_t count) {
  return camera.map(key).numbers("data", count);
}

LensModel model_of(const YamlMap& camera) {
  const std::string word = camera.word("distortion_model");
  if (word == "plumb_bob" || word == "rational_polynomial") return LensModel::radial_tangential;
  if (word == "equidistant" || word == "fisheye") return LensModel::equidistant;
  camera.complain("distortion_model", in_quotes(word), "plumb_bob, rational_polynomial or equidistant");
}

/// Position of a rectified camera in the left camera frame, from its K [I | t].
Eigen::Vector3d offset_of(const YamlMap& camera) {
  const auto p = matrix_of(camera, "projection_matrix", 12);
  if (!(p[0] > 0 && p[5] > 0)) camera.complain("projection_matrix", "no focal length", "fx' and fy' above zero");
  if (p[8] != 0 || p[9] != 0 || p[10] != 1 || p[11] != 0)
    camera.complain("projection_matrix", "a last row other than 0 0 1 0", "a rectified camera's");
  return {p[3] / p[0], p[7] / p[5], 0};
}

CameraInfo read_camera_info(const YamlMap& camera) {
  CameraInfo info;
  const ImageSize size = camera.size("image_width", "image_height");
  const auto k = matrix_of(camera, "camera_matrix", 9);
  info.lens.model = model_of(camera);
  info.lens.camera = {k[0], k[4], k[2], k[5], size.width, size.height};
  info.lens.parameters = camera.map("distortion_coefficients").numbers("data");
  check_lens(info.lens, camera.file(), "camera_matrix", "distortion_coefficients");
  const auto r = matrix_of(camera, "rectification_matrix", 9);
  const Eigen::Matrix3d rotation = Eigen::Map<const Eigen::Matrix3d>(r.data()).transpose();
  info.rectified_from_camera = nearest_rotation(rotation, camera.file() + " (rectification_matrix)");
  info.rectified_from_left_rectified = offset_of(camera);
  return info;
}

}  // namespace

StereoCalibration read_ros_camera_infos(const YamlMap& left_file, const YamlMap& right_file) {
  const CameraInfo left = read_camera_info(left_file), right = read_camera_info(right_file);
  if (!left.rectified_from_left_rectified.isZero())
    left_file.complain("projection_matrix", "a baseline",
                       "0 in the left camera's fourth column: are the files exchanged?");
  StereoCalibration calibration;
  calibration.left = left.lens;
  calibration.right = right.lens;
  const Eigen::Matrix3d right_from_rectified = right.rectified_from_camera.transpose();
  calibration.right_from_left.linear() = right_from_rectified * left.rectified_from_camera;
  calibration.right_from_left.translation() = right_from_rectified * right.rectified_from_left_rectified;
  return calibration;
}

}  // namespace quadedge::data
