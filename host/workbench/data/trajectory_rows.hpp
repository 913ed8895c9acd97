#pragma once
/// \file trajectory_rows.hpp  Single rows of trajectory files, for incremental writing.

#include <optional>
#include <string>
#include <string_view>

#include "quadedge/trajectory.hpp"

namespace quadedge::data {

/// A pose that a file states. \param order of its quaternion there \throws DataError for one that is not a rotation's
Eigen::Isometry3d stated_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation, const char* order,
                              const std::string& file, int line);
/// Poses of a CSV file as EuRoC, TUM-VI and VINS-Fusion write it: timestamp [ns], position, quaternion w x y z, and
/// columns that are not used. \throws DataError
Trajectory read_euroc_poses(const std::string& file);
/// The same of the left camera, for a data.csv of ground truth beside cam0/sensor.yaml. \throws DataError without it
Trajectory read_euroc_truth(const std::string& file);
/// The pose nearest in time, among poses with increasing timestamps; null if none is within the tolerance.
const StampedPose* pose_at(const Trajectory& poses, std::int64_t stamp_ns, std::int64_t tolerance_ns);
/// First line of a TUM file: a comment with column names and units.
std::string tum_header();
/// The comment that precedes the first pose of a segment other than the first.
std::string tum_segment(int segment);
/// The segment that such a comment announces; nothing for any other line.
std::optional<int> announced_segment(std::string_view line);
/// One TUM row with line ending; the quaternion has a non-negative w.
std::string tum_row(const StampedPose& pose);
/// One KITTI row with line ending.
std::string kitti_row(const StampedPose& pose);

}  // namespace quadedge::data
