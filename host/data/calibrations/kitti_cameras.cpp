/// \file kitti_cameras.cpp  KITTI's calib_cam_to_cam.txt and KITTI-360's perspective.txt: for camera NN the size S, K,
/// D and pose R, T of the camera as it records, and size S_rect, rotation R_rect and projection P_rect of its rectified
/// images. Metres; all cameras refer to camera 00.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

ImageSize size_of(const YamlMap& cameras, const std::string& key) {
  const auto values = cameras.matrix(key, 1, 2);
  for (const double value : values)
    if (!(value >= 1 && value <= kLargestImageSide) || value != std::floor(value))
      cameras.complain(key, "a side of " + format_exact(value), "whole numbers of pixels");
  return {static_cast<int>(values[0]), static_cast<int>(values[1])};
}

StatedLens read_rectified(const YamlMap& cameras, const std::string& number) {
  StatedLens stated(cameras.file(), "P_rect_" + number, "P_rect_" + number);
  const ImageSize size = size_of(cameras, "S_rect_" + number);
  const auto p = cameras.matrix("P_rect_" + number, 3, 4);
  stated.lens.camera = {p[0], p[5], p[2], p[6], size.width, size.height};
  return stated;
}

StatedLens read_recording(const YamlMap& cameras, const std::string& number) {
  StatedLens stated(cameras.file(), "K_" + number, "D_" + number);
  const ImageSize size = size_of(cameras, "S_" + number);
  stated.lens.camera.width = size.width;
  stated.lens.camera.height = size.height;
  set_intrinsics(cameras, "K_" + number, stated.lens.camera);
  stated.lens.parameters = cameras.matrix("D_" + number).values;
  return stated;
}

Eigen::Isometry3d camera_from_reference(const YamlMap& cameras, const std::string& number) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = cameras.rotation("R_" + number);
  transform.translation() = cameras.vector("T_" + number);
  return transform;
}

}  // namespace

StatedCalibration read_kitti_cameras(const YamlMap& cameras, const std::string& left, const std::string& right) {
  StatedCalibration rectified;
  rectified.left = read_rectified(cameras, left);
  rectified.right = read_rectified(cameras, right);
  rectified.right_from_left.translation() =
      projection_offset(cameras, "P_rect_" + right) - projection_offset(cameras, "P_rect_" + left);
  if (cameras.has("K_" + left) && cameras.has("K_" + right) && cameras.has("S_" + left)) {
    StatedCalibration recording;
    recording.left = read_recording(cameras, left);
    recording.right = read_recording(cameras, right);
    recording.right_from_left = camera_from_reference(cameras, right) * camera_from_reference(cameras, left).inverse();
    rectified.other_sizes.push_back(std::move(recording));
  }
  return rectified;
}

}  // namespace quadedge::data
