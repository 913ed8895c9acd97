#pragma once
/// \file trajectory.hpp  Trajectories and their files (TUM, KITTI).

#include <cstdint>
#include <string>
#include <vector>

#include "quadedge/poses.hpp"

namespace quadedge {

/// Largest difference of the timestamps of a pose and its ground truth [ns].
constexpr std::int64_t kStampToleranceNs = 10'000'000;

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

}  // namespace quadedge
