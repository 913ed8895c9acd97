#pragma once
/// \file candidates.hpp  Plain C++ twins of kernels/scan.cl and kernels/candidate_filters.cl: candidate lists and
/// the filters over them.

#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "common/layouts.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::reference {

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

/// Candidate lists in compressed rows: row i owns first[i] .. first[i + 1] of target.
struct Candidates {
  std::vector<std::int32_t> first;   ///< rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
};

/// Patches (kEdgePatchBytes per edge, reference/edge_descriptions.hpp) and SIFT descriptors (256 bytes per edge,
/// reference/edge_descriptions.hpp).
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

/// Sets the state of every candidate from its scores.
void decide(const Candidates& candidates, const FilterLimits& limits, CandidateScores& scores);

/// Row r of `candidates` belongs to edge r * row_step of `a`; targets are edges of `b`.
CandidateScores candidate_filters(const Candidates& candidates, const EdgeDescriptions& a, const EdgeDescriptions& b,
                                  const FilterLimits& limits, int row_step = 1);

/// Candidates that no filter up to `filter` has rejected, with the scores that the next filter compares.
template <class Filter>
CandidateLists alive_after(Filter filter, const Candidates& candidates, const CandidateScores& scores) {
  const Filter judge = next(filter);
  const bool by_sift = judge == Filter::sift || judge == Filter::nearly_best_sift,
             by_ncc = judge == Filter::ncc || judge == Filter::nearly_best_ncc;
  CandidateLists lists;
  lists.first.assign(1, 0);
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    for (auto c = static_cast<std::size_t>(candidates.first[row]);
         c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      if (scores.state[c] != kCandidateAlive && scores.state[c] <= order_of(filter)) continue;
      lists.target.push_back(candidates.target[c]);
      if (by_sift || by_ncc) lists.cue.push_back(by_sift ? scores.sift[c] : scores.ncc[c]);
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  return lists;
}

}  // namespace quadedge::reference
