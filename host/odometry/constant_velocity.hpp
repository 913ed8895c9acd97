#pragma once
/// \file constant_velocity.hpp  The motion expected of the next frames: that of the last ones.

#include <Eigen/Geometry>
#include <optional>

namespace quadedge::odometry {

/// The motion of one frame interval. It predicts and estimates nothing.
class ConstantVelocity {
 public:
  /// Takes in a motion over `intervals` equal frame intervals, its translation spread evenly.
  void observe(const Eigen::Isometry3d& current_from_earlier, int intervals);
  /// No velocity is known from now on.
  void forget() { one_interval_ = std::nullopt; }

  /// current_from_earlier over `intervals` frame intervals; nothing where no velocity is known.
  std::optional<Eigen::Isometry3d> predict(int intervals) const;

 private:
  std::optional<Eigen::Isometry3d> one_interval_;
};

}  // namespace quadedge::odometry
