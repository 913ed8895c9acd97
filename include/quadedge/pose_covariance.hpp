#pragma once
/// \file pose_covariance.hpp  How uncertain a pose is, in the form that ROS's PoseWithCovariance has.

#include <Eigen/Core>

namespace quadedge {

/// Covariance of the pose of a camera in a fixed frame: (x, y, z [m], rotation about x, y, z [rad]), all along and
/// about the axes of the FIXED frame. The errors are position_estimate - position_true and the rotation vector of
/// R_estimate R_true^T, where R turns the camera's axes into those of the fixed frame.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// What a calibration may have wrong, alike for all frames of a recording (doc/method.md section 7):
///   0        length of the baseline, as a ratio
///   1, 2, 3  turn of the left camera's optical frame about its x, y, z [rad]: principal point, image axes
///   4        focal length, as a ratio of the angles seen
///   5, 6, 7  what is left of the lens's distortion: a turn about x, y, z [rad] per (length of the way x inverse depth)
constexpr int kRigErrors = 8;

/// How much a pose in a fixed frame errs, in the order and about the axes of PoseCovariance, per unit of each of them.
using RigSensitivity = Eigen::Matrix<double, 6, kRigErrors>;

}  // namespace quadedge
