#pragma once
/// \file poses.hpp  Poses with timestamps, and the covariance of a pose.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace quadedge {

/// One pose of the left camera.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();
  /// Poses of different segments are not connected by measurements, see FrameResult::segment.
  int segment = 0;
};
using Trajectory = std::vector<StampedPose>;

/// Covariance of a camera pose in a fixed frame: (x, y, z [m], rotation about x, y, z [rad]), along and about the axes
/// of the FIXED frame. The errors are position_estimate - position_true and the rotation vector of R_estimate R_true^T,
/// where R rotates from the camera frame to the fixed frame.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Calibration errors, which are common to all frames of a recording (doc/method.md section 7):
///   0        relative error of the baseline length
///   1, 2, 3  rotation of the left camera's optical frame about its x, y, z [rad]: principal point, image axes
/// and residual lens distortion, per motion of the image [rad], which is path length x inverse depth + rotation:
///   4, 5, 6  a rotation about x, y, z [rad]
///   7, 8, 9  a translation along x, y, z, relative to the depth, per rotation only
/// and, last, what was not known of the disparity offset when the motion was measured, in its standard deviations then.
constexpr int kRigErrors = 11;

/// Derivative of the error of a pose in a fixed frame, in the order and about the axes of PoseCovariance, with respect
/// to each of these errors.
using RigSensitivity = Eigen::Matrix<double, 6, kRigErrors>;

}  // namespace quadedge
