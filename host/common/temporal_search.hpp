#pragma once
/// \file temporal_search.hpp  Search areas of the temporal matching.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "quadedge/edges.hpp"

namespace quadedge {

/// One entry per stereo edge of the base, an earlier rig: its predicted position in the current images.
struct TemporalSearch {
  EdgePositions left, right;
  float radius = 0;     ///< [px], around the predicted position
  int step = 1;         ///< only every step-th previous edge is matched
  bool coarse = false;  ///< whether the limits TemporalConfig::coarse_* apply
};

/// Indices of the stereo edges of the base and of the current rig that take part in a global search.
struct GlobalSearch {
  std::vector<std::int32_t> of_base, of_current;
};

/// Step of the edges used in a global search, so that about `wanted` of `count` take part.
inline int wide_step(std::size_t count, int wanted) {
  const int step = static_cast<int>(count) / wanted;
  return step > 1 ? step : 1;
}

}  // namespace quadedge
