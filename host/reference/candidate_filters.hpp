#pragma once
/// \file candidate_filters.hpp  Plain C++ twin of kernels/candidate_filters.cl.

#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "common/layouts.hpp"
#include "reference/stereo_candidates.hpp"

namespace quadedge::reference {

/// Patches (kEdgePatchBytes per edge, reference/patches.hpp) and SIFT descriptors (256 bytes per edge,
/// reference/sift.hpp).
struct EdgeDescriptions {
  std::vector<std::int8_t> patches;
  std::vector<std::uint8_t> sift;  ///< empty: no filter asks for them
};

/// One entry per candidate.
struct CandidateScores {
  std::vector<float> ncc;           ///< highest of the four side pairings
  std::vector<float> sift;          ///< smallest of the four L2 distances; 0 without descriptors
  std::vector<std::uint8_t> state;  ///< alive, rejected by or represented: kernels/layouts.cl
};

/// Row r of `candidates` belongs to edge r * row_step of `a`; targets are edges of `b`.
CandidateScores candidate_filters(const Candidates& candidates, const EdgeDescriptions& a, const EdgeDescriptions& b,
                                  const FilterLimits& limits, int row_step = 1);

}  // namespace quadedge::reference
