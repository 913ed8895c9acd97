#pragma once
/// \file temporal_search.hpp  Where the matching in time looks.

#include <cstddef>

#include "quadedge/edges.hpp"

namespace quadedge {

/// One entry per stereo edge of the base, an earlier rig: where it is expected in the current images.
struct TemporalSearch {
  EdgePositions left, right;
  float radius = 0;     ///< px around the expected position
  int step = 1;         ///< only every step-th previous edge is looked for
  bool coarse = false;  ///< the limits of TemporalConfig::coarse_* hold
};

/// Every wide_step()-th edge takes part in a search anywhere in the image: about `wanted` of `count`.
inline int wide_step(std::size_t count, int wanted) {
  const int step = static_cast<int>(count) / wanted;
  return step > 1 ? step : 1;
}

}  // namespace quadedge
