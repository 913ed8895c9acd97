#include "odometry/disparity_offset.hpp"

#include "odometry/odometry_constants.hpp"

namespace quadedge::odometry {

namespace {

/// Unit vector along which a point in the middle of the right image moves when its depth decreases.
Eigen::Vector2d direction_of_nearer(const StereoRig& rig) {
  // For the middle of the image, between depths of 100 and 50 baselines.
  const Eigen::Vector3d ray = rig.left.ray({0.5 * (rig.left.width - 1), 0.5 * (rig.left.height - 1)});
  const Eigen::Vector2d far = rig.right.project(rig.right_from_left * Eigen::Vector3d(100 * rig.baseline() * ray));
  return (rig.right.project(rig.right_from_left * Eigen::Vector3d(50 * rig.baseline() * ray)) - far).normalized();
}

}  // namespace

StereoRig with_disparity_offset(const StereoRig& rig, double offset) {
  const Eigen::Vector2d nearer = direction_of_nearer(rig);
  StereoRig moved;
  moved.left = rig.left;
  moved.right = rig.right;
  moved.right_from_left = rig.right_from_left;
  moved.max_value = rig.max_value;
  moved.right_error = rig.right_error;
  moved.right.cx -= offset * nearer.x();
  moved.right.cy -= offset * nearer.y();
  return moved;
}

DisparityOffset::DisparityOffset(const StereoRig& rig, const PoseConfig& config)
    : calibration_(with_disparity_offset(rig, 0)),
      rig_(with_disparity_offset(rig, config.disparity_offset)),
      drift_(kDisparityOffsetDrift),
      value_(config.disparity_offset),
      variance_(config.disparity_offset_sigma * config.disparity_offset_sigma) {}

void DisparityOffset::update(double correction, double variance, int frames) {
  if (!(variance_ > 0) || !(variance > 0)) return;
  value_ += correction;
  variance_ = variance + frames * drift_ * drift_ + (has_jumped() ? kJumpSigma * kJumpSigma : 0);
  rig_ = rig_at(frame_);
}

void DisparityOffset::start_frame(int frame, const std::function<bool(int)>& is_base) {
  const bool follows_jump = jump(frame_) != 0;
  has_jumped_ = has_jumped();
  for (auto jump = jumps_.begin(); jump != jumps_.end();)
    jump = is_base(jump->first) ? std::next(jump) : jumps_.erase(jump);
  frame_ = frame;
  if (follows_jump || jump(frame) != 0) set_jump(0);
}

void DisparityOffset::set_jump(double jump) {
  if (jump == 0) {
    jumps_.erase(frame_);
  } else {
    jumps_[frame_] = jump;
  }
  rig_ = rig_at(frame_);
}

double DisparityOffset::jump(int frame) const {
  const auto found = jumps_.find(frame);
  return found == jumps_.end() ? 0 : found->second;
}

}  // namespace quadedge::odometry
