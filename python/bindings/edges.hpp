#pragma once
/// \file edges.hpp  Stereo edges for Python: with their points in space.

#include "bindings.hpp"
#include "quadedge/edge_points.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::python {

struct StereoEdgesInSpace {
  StereoEdges edges;
  EdgePoints points;
};

/// Matches in time and the edges that they connect.
struct Quads {
  TemporalMatches matches;
  std::vector<std::uint8_t> inlier;
};

}  // namespace quadedge::python
