#pragma once
/// \file relative_pose.hpp  A rigid motion with covariance.

#include <Eigen/Geometry>

namespace quadedge::pose {

/// `transform` is b_from_a [m]; `covariance` refers to a left perturbation in frame b: (rotation [rad^2], translation
/// [m^2]). The default is the exact identity.
struct RelativePose {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Maps a left perturbation before `transform` (rotation, translation) to the perturbation after it.
Eigen::Matrix<double, 6, 6> adjoint(const Eigen::Isometry3d& transform);

/// c_from_a from c_from_b and b_from_a, with independent errors.
RelativePose operator*(const RelativePose& c_from_b, const RelativePose& b_from_a);

}  // namespace quadedge::pose
