#pragma once
/// \file constant_velocity.hpp  Prediction by constant velocity.

#include <Eigen/Geometry>
#include <optional>

namespace quadedge::odometry {

/// The motion per frame interval.
class ConstantVelocity {
 public:
  /// Sets the velocity from a motion over `intervals` equal frame intervals; its translation is divided evenly.
  void observe(const Eigen::Isometry3d& current_from_earlier, int intervals);
  /// Resets the velocity to unknown.
  void forget() { one_interval_ = std::nullopt; }

  /// Returns current_from_earlier over `intervals` frame intervals, or nothing if no velocity is known.
  std::optional<Eigen::Isometry3d> predict(int intervals) const;

 private:
  std::optional<Eigen::Isometry3d> one_interval_;
};

}  // namespace quadedge::odometry
