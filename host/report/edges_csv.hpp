#pragma once
/// \file edges_csv.hpp  Edges as a table.

#include <string>

#include "quadedge/edges.hpp"

namespace quadedge::report {

/// Columns `x,y,direction_rad,strength`, 6 decimals, with a header line; pixels, radians, grey levels per pixel.
std::string edges_csv(const EdgeSet& edges);

}  // namespace quadedge::report
