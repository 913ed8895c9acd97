#pragma once
/// \file trajectory_rows.hpp  Single rows of trajectory files, for incremental writing.

#include <string>

#include "quadedge/trajectory.hpp"

namespace quadedge::data {

/// First line of a TUM file: a comment with column names and units.
std::string tum_header();
/// One TUM row with line ending; the quaternion has a non-negative w.
std::string tum_row(const StampedPose& pose);
/// One KITTI row with line ending.
std::string kitti_row(const StampedPose& pose);

}  // namespace quadedge::data
