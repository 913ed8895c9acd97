#pragma once
/// \file candidate_lists.hpp  Candidates in compressed rows on the host, what the filters decided about them, and their
/// clusters.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/tap.hpp"

namespace quadedge {

/// Candidate lists in compressed rows: row i owns first[i] .. first[i + 1] of target.
struct Candidates {
  std::vector<std::int32_t> first;   ///< rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
};

/// One entry per candidate.
struct CandidateScores {
  std::vector<float> ncc;           ///< highest of the four side pairings
  std::vector<float> sift;          ///< smallest of the four L2 distances; 0 without descriptors
  std::vector<std::uint8_t> state;  ///< alive, rejected by or represented: kernels/layouts.cl
};

/// Representatives of clusters of candidates. Row i (left edge) owns first[i] .. first[i + 1].
struct StereoClusters {
  std::vector<std::int32_t> first;
  std::vector<double> position;      ///< on the left edge's epipolar line [px from the point at infinity]
  std::vector<double> direction;     ///< [rad], weighted mean of the members
  std::vector<std::int32_t> anchor;  ///< right edge of the most similar member; among equals the first in scan order
  std::vector<double> similarity;    ///< of that member
};

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

}  // namespace quadedge
