#include "odometry/constant_velocity.hpp"

namespace quadedge::odometry {

void ConstantVelocity::observe(const Eigen::Isometry3d& current_from_earlier, int intervals) {
  const Eigen::AngleAxisd rotation(current_from_earlier.linear());
  one_interval_ = Eigen::Isometry3d::Identity();
  one_interval_->linear() = Eigen::AngleAxisd(rotation.angle() / intervals, rotation.axis()).toRotationMatrix();
  one_interval_->translation() = current_from_earlier.translation() / intervals;
}

std::optional<Eigen::Isometry3d> ConstantVelocity::predict(int intervals) const {
  if (!one_interval_) return std::nullopt;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (int i = 0; i < intervals; ++i) motion = *one_interval_ * motion;
  return motion;
}

}  // namespace quadedge::odometry
