#pragma once
/// \file trajectory.hpp  Trajectories, their files (TUM, KITTI), and the covariance of a pose.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
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

/// Checks that every pose is a rotation and a translation of finite numbers. `source`: what the poses are, for the
/// message. \throws DataError
void check_trajectory(const Trajectory& trajectory, const std::string& source);

/// The poses of each segment by themselves, in order.
std::vector<Trajectory> split_segments(const Trajectory& trajectory);

/// TUM format: `timestamp tx ty tz qx qy qz qw`, seconds with 9 decimals; '#' starts a comment. A comment `# segment N`
/// precedes the poses of each segment after the first; other programs skip it. Stamps increase within a segment.
/// \throws DataError that names file and line, what was found and what was expected.
Trajectory read_tum(const std::string& path);
/// Written to a temporary name and renamed. \throws DataError if the file cannot be written (including a full disk).
void write_tum(const std::string& path, const Trajectory& trajectory);

/// KITTI format: 12 numbers per line, row-major 3 x 4. Timestamps are `stamps_ns` (of the same length) or, if empty,
/// the row numbers in ns.
Trajectory read_kitti(const std::string& path, const std::vector<std::int64_t>& stamps_ns = {});
void write_kitti(const std::string& path, const Trajectory& trajectory);

/// Reads TUM or KITTI format, according to the number of columns in the first data line (8 or 12).
Trajectory read_trajectory(const std::string& path);

/// Covariance of a camera pose in a fixed frame: (x, y, z [m], rotation about x, y, z [rad]), along and about the axes
/// of the FIXED frame. The errors are position_estimate - position_true and the rotation vector of R_estimate R_true^T,
/// where R rotates from the camera frame to the fixed frame.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Calibration errors, which are common to all frames of a recording (doc/method.md section 7):
///   0        relative error of the baseline length
///   1, 2, 3  rotation of the left camera's optical frame about its x, y, z [rad]: principal point, image axes
///   4        relative error of the focal length
/// and residual lens distortion, per motion of the image [rad], which is path length x inverse depth + rotation:
///   5, 6, 7  a rotation about x, y, z [rad]
///   8, 9, 10 a translation along x, y, z, relative to the depth, per rotation only
/// and, last, what was not known of the disparity offset when the motion was measured, in its standard deviations then.
constexpr int kRigErrors = 12;

/// Derivative of the error of a pose in a fixed frame, in the order and about the axes of PoseCovariance, with respect
/// to each of these errors.
using RigSensitivity = Eigen::Matrix<double, 6, kRigErrors>;

}  // namespace quadedge
