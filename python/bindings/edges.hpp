#pragma once
/// \file edges.hpp  Stereo edges with their 3-D points, and quads, for Python.

#include "bindings.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/match_stereo.hpp"

namespace quadedge::python {

struct StereoEdgesInSpace : StereoEdges {
  EdgePoints points;
};

/// Matches between the stereo edges of two frames.
struct Quads : TemporalMatches {
  std::vector<std::uint8_t> inlier;
};

}  // namespace quadedge::python
