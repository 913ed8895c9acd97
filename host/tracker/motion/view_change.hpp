#pragma once
/// \file view_change.hpp  How differently two cameras see a scene.

#include <Eigen/Geometry>

namespace quadedge::odometry {

/// Bound of the angle [rad] by which a motion turns the directions to points. \param inverse_depth of the points [1/m]
inline double view_change(const Eigen::Isometry3d& motion, double inverse_depth) {
  return Eigen::AngleAxisd(motion.linear()).angle() + motion.translation().norm() * inverse_depth;
}

/// Views that differ by less than this [rad] share most of the image.
constexpr double kSameView = 0.3;

}  // namespace quadedge::odometry
