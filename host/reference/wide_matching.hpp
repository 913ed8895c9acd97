#pragma once
/// \file wide_matching.hpp  Plain C++ twin of kernels/wide_matching.cl.

#include <cstdint>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::reference {

/// Every wide_step()-th edge takes part in a wide search: about `wanted` of `count`.
inline int wide_step(std::size_t count, int wanted) {
  const int step = static_cast<int>(count) / wanted;
  return step > 1 ? step : 1;
}

/// Some stereo edges of one rig with their wide descriptors: every step-th.
struct WideEdges {
  const StereoEdges& edges;
  int step;
  std::vector<std::uint8_t> descriptors;  ///< reference::kWideBytes each
};

/// Finds the earlier edges among the current ones, anywhere in the left image: the most alike, if it is mutually best and no rival
/// elsewhere comes near (config.wide_ratio; "elsewhere": farther than config.wide_neighbourhood px). The matches' ncc is the cosine of
/// the two descriptors; they have no rivals.
TemporalMatches wide_matches(const WideEdges& earlier, const WideEdges& current, const TemporalConfig& config);

}  // namespace quadedge::reference
