#pragma once
/// \file edges_csv.hpp  Edges of an image and stereo edges of a pair as tables.

#include <string>

#include "quadedge/edges.hpp"
#include "quadedge/match_stereo.hpp"

namespace quadedge::report {

/// Columns `x,y,direction_rad,strength`, 6 decimals, with a header line; pixels, radians, grey levels per pixel.
std::string edges_csv(const EdgeSet& edges);

/// Columns `left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m`, 6 decimals, with
/// a heading: pixels and radians, the similarity of the pair (-1 to 1), the point in the left camera's frame. The last
/// three are empty for an edge without a point, and for all edges without `depths`.
std::string matches_csv(const StereoMatches& matches, bool depths);

}  // namespace quadedge::report
