#pragma once
/// \file trajectory.hpp  Trajectories and their files (TUM, KITTI).

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

/// TUM format: `timestamp tx ty tz qx qy qz qw`, seconds with 9 decimals; '#' starts a comment. A comment `# segment N`
/// precedes the poses of each segment after the first; other programs skip it.
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

}  // namespace quadedge
