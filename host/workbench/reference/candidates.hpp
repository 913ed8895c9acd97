#pragma once
/// \file candidates.hpp  Plain C++ twins of kernels/scan.cl and kernels/candidate_filters.cl: candidate lists and
/// the filters over them.

#include <cstdint>
#include <vector>

#include "common/candidate_lists.hpp"
#include "common/filter_limits.hpp"
#include "common/layouts.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::reference {

using quadedge::Candidates;
using quadedge::CandidateScores;

// Plain C++ twin of kernels/scan.cl.

/// Starts of rows in a list with room for `capacity` elements.
struct Scan {
  std::vector<std::int32_t> first;  ///< size counts + 1: min(counts[0] + ... + counts[i - 1], capacity)
  std::int32_t fitting = 0;         ///< elements that fit
  std::int32_t cut_off = 0;         ///< elements beyond the capacity
};

/// Exclusive prefix sums of counts that are not negative.
Scan scan(const std::vector<std::int32_t>& counts, std::int32_t capacity);

// Plain C++ twin of kernels/candidate_filters.cl.

/// Patches (kEdgePatchBytes per edge, reference/edge_descriptions.hpp) and SIFT descriptors (256 bytes per edge,
/// reference/edge_descriptions.hpp).
struct EdgeDescriptions {
  std::vector<std::int8_t> patches;
  std::vector<std::uint8_t> sift;  ///< empty: no filter asks for them
};

/// Sets the state of every candidate from its scores.
void decide(const Candidates& candidates, const FilterLimits& limits, CandidateScores& scores);

/// Row r of `candidates` belongs to edge r * row_step of `a`; targets are edges of `b`.
CandidateScores candidate_filters(const Candidates& candidates, const EdgeDescriptions& a, const EdgeDescriptions& b,
                                  const FilterLimits& limits, int row_step = 1);

}  // namespace quadedge::reference
