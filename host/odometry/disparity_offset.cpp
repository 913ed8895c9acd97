#include "odometry/disparity_offset.hpp"

namespace quadedge::odometry {

Eigen::Vector2d direction_of_nearer(const StereoRig& rig) {
  // At the image's middle, from a hundred base lines to fifty.
  const Eigen::Vector3d ray = rig.left.ray({0.5 * (rig.left.width - 1), 0.5 * (rig.left.height - 1)});
  const Eigen::Vector2d far = rig.right.project(rig.right_from_left * Eigen::Vector3d(100 * rig.baseline() * ray));
  return (rig.right.project(rig.right_from_left * Eigen::Vector3d(50 * rig.baseline() * ray)) - far).normalized();
}

DisparityOffset::DisparityOffset(const StereoRig& rig, const PoseConfig& config)
    : rig_(rig),
      cx_(rig.right.cx),
      cy_(rig.right.cy),
      nearer_(direction_of_nearer(rig)),
      drift_(config.disparity_offset_drift),
      variance_(config.disparity_offset_sigma * config.disparity_offset_sigma) {
  rig_.left_undistortion = rig_.right_undistortion = {};
}

void DisparityOffset::update(double correction, double variance, int frames) {
  if (!(variance_ > 0) || !(variance > 0)) return;
  value_ += correction;
  variance_ = variance + frames * drift_ * drift_;
  rig_.right.cx = cx_ - value_ * nearer_.x();
  rig_.right.cy = cy_ - value_ * nearer_.y();
}

}  // namespace quadedge::odometry
