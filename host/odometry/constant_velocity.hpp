#pragma once
/// \file constant_velocity.hpp  Prediction by constant velocity.

#include <Eigen/Geometry>
#include <optional>

namespace quadedge::odometry {

/// The motion per frame interval.
class ConstantVelocity {
 public:
  /// Sets the velocity from a motion over `intervals` equal frame intervals; its translation is divided evenly.
  void observe(const Eigen::Isometry3d& current_from_earlier, int intervals) {
    const Eigen::AngleAxisd rotation(current_from_earlier.linear());
    one_interval_ = Eigen::Isometry3d::Identity();
    one_interval_->linear() = Eigen::AngleAxisd(rotation.angle() / intervals, rotation.axis()).toRotationMatrix();
    one_interval_->translation() = current_from_earlier.translation() / intervals;
  }
  /// Resets the velocity to unknown.
  void forget() { one_interval_ = std::nullopt; }

  /// Returns current_from_earlier over `intervals` frame intervals, or nothing if no velocity is known.
  std::optional<Eigen::Isometry3d> predict(int intervals) const {
    if (!one_interval_) return std::nullopt;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    for (int i = 0; i < intervals; ++i) motion = *one_interval_ * motion;
    return motion;
  }

 private:
  std::optional<Eigen::Isometry3d> one_interval_;
};

}  // namespace quadedge::odometry
