#pragma once
/// \file pose_covariance.hpp  Covariance of a pose, as in ROS's PoseWithCovariance.

#include <Eigen/Core>

namespace quadedge {

/// Covariance of a camera pose in a fixed frame: (x, y, z [m], rotation about x, y, z [rad]), along and about the axes
/// of the FIXED frame. The errors are position_estimate - position_true and the rotation vector of R_estimate R_true^T,
/// where R rotates from the camera frame to the fixed frame.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Calibration errors, which are common to all frames of a recording (doc/method.md section 7):
///   0        relative error of the baseline length
///   1, 2, 3  rotation of the left camera's optical frame about its x, y, z [rad]: principal point, image axes
///   4        relative error of the focal length
///   5, 6, 7  residual lens distortion: a rotation about x, y, z [rad] per (path length x inverse depth)
constexpr int kRigErrors = 8;

/// Derivative of the error of a pose in a fixed frame, in the order and about the axes of PoseCovariance, with respect
/// to each of these errors.
using RigSensitivity = Eigen::Matrix<double, 6, kRigErrors>;

}  // namespace quadedge
