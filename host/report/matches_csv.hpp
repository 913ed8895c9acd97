#pragma once
/// \file matches_csv.hpp  Stereo edges of a pair as a table.

#include <string>

#include "quadedge/match_stereo.hpp"

namespace quadedge::report {

/// Columns `left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m`, 6 decimals, with
/// a heading: pixels and radians, the similarity of the pair (-1 to 1), the point in the left camera's frame. The last
/// three are empty for an edge without a point, and for all edges without `depths`.
std::string matches_csv(const StereoMatches& matches, bool depths);

}  // namespace quadedge::report
