#pragma once
/// \file trajectory_rows.hpp  Single rows of trajectory files, for writers that add a pose at a time.

#include <string>

#include "quadedge/trajectory.hpp"

namespace quadedge::data {

/// First line of a TUM file: a comment that names columns and units.
std::string tum_header();
/// One TUM row with its line end; the quaternion has a non-negative w.
std::string tum_row(const StampedPose& pose);
/// One KITTI row with its line end.
std::string kitti_row(const StampedPose& pose);

}  // namespace quadedge::data
