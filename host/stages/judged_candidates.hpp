#pragma once
/// \file judged_candidates.hpp  Candidate lists on the host with what every filter decided, for a tap.

#include <cstdint>
#include <vector>

#include "quadedge/tap.hpp"

namespace quadedge::stages {

/// Compressed rows: row r owns first[r] .. first[r + 1] of the other arrays.
struct JudgedCandidates {
  std::vector<std::int32_t> first, target;
  std::vector<std::uint8_t> state;  ///< alive, rejected by or represented: kernels/layouts.cl
  std::vector<float> ncc, sift;     ///< similarity and distance; undefined where no filter has computed them

  /// Candidates that no filter of order <= `order` has rejected. `cue`: ncc, sift or null.
  CandidateLists alive_after(int order, const std::vector<float>* cue) const;
};

}  // namespace quadedge::stages
