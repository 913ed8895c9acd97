#pragma once
/// \file wide_matching.hpp  Plain C++ twin of kernels/wide_matching.cl.

#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::reference {

/// Some stereo edges of one rig with their wide descriptors: every step-th.
struct WideEdges {
  const StereoEdges& edges;
  int step;
  std::vector<std::uint8_t> descriptors;  ///< kWideBytes each
};

/// Finds the earlier edges among the current ones, anywhere in the left image: the most similar one, if it is mutually
/// best and no match elsewhere is nearly as good (kWideRatio; "elsewhere": farther than
/// kWideNeighbourhood px). The matches' ncc is the cosine of the two descriptors; they have no competing
/// clusters.
TemporalMatches wide_matches(const WideEdges& earlier, const WideEdges& current);

}  // namespace quadedge::reference
