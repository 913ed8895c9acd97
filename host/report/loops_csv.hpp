#pragma once
/// \file loops_csv.hpp  loops.csv: the comparisons of frames with earlier key stereo rigs.

#include <string>
#include <vector>

#include "quadedge/map.hpp"

namespace quadedge::report {

/// Columns: frame, other, verdict, similarity, inliers, support; x, y, z [m] and qx, qy, qz, qw of the frame's left
/// camera in that of the other frame, empty without a motion; deviation, distance_m and angle_deg from the map before,
/// empty for frames of different segments.
std::string loops_csv(const std::vector<Closure>& closures);

}  // namespace quadedge::report
