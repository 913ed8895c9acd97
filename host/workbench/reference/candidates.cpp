/// \file candidates.cpp  Limits of NCC and SIFT first, then those relative to a row's best NCC and best SIFT.
#include "reference/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "reference/edge_descriptions.hpp"

namespace quadedge::reference {

Scan scan(const std::vector<std::int32_t>& counts, std::int32_t capacity) {
  Scan result;
  std::int32_t sum = 0;
  for (const std::int32_t count : counts) {
    result.first.push_back(std::min(sum, capacity));
    sum += count;
  }
  result.fitting = std::min(sum, capacity);
  result.first.push_back(result.fitting);
  result.cut_off = sum - result.fitting;
  return result;
}

void decide(const Candidates& candidates, const FilterLimits& limits, CandidateScores& scores) {
  scores.state.assign(candidates.target.size(), kCandidateAlive);
  const int nearly_best_order = std::max(limits.ncc_order, limits.sift_order) + 1;
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    const auto begin = static_cast<std::size_t>(candidates.first[row]),
               end = static_cast<std::size_t>(candidates.first[row + 1]);
    float best_ncc = 0;
    for (std::size_t c = begin; c < end; ++c) {
      int rejected = 0;
      if (scores.ncc[c] < limits.ncc_min) rejected = limits.ncc_order;
      if (limits.sift_max > 0 && scores.sift[c] > limits.sift_max)
        rejected = rejected == 0 ? limits.sift_order : std::min(rejected, limits.sift_order);
      scores.state[c] = static_cast<std::uint8_t>(rejected);
      if (rejected == 0) best_ncc = std::max(best_ncc, scores.ncc[c]);
    }
    float best_sift = INFINITY;
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      if (scores.ncc[c] < limits.ncc_nearly_best * best_ncc) {
        scores.state[c] = static_cast<std::uint8_t>(nearly_best_order);
      } else {
        best_sift = std::min(best_sift, scores.sift[c]);
      }
    }
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] == kCandidateAlive && limits.sift_max > 0 &&
          limits.sift_nearly_best * scores.sift[c] > best_sift) {
        scores.state[c] = static_cast<std::uint8_t>(nearly_best_order + 1);
      }
    }
  }
}

CandidateScores candidate_filters(const Candidates& candidates, const EdgeDescriptions& a, const EdgeDescriptions& b,
                                  const FilterLimits& limits, int row_step) {
  CandidateScores scores;
  const std::size_t total = candidates.target.size();
  scores.ncc.resize(total);
  scores.sift.resize(total);
  const auto patch = [](const EdgeDescriptions& set, std::size_t i) {
    return set.patches.data() + i * kEdgePatchBytes;
  };
  const auto sift = [](const EdgeDescriptions& set, std::size_t i) { return set.sift.data() + i * kEdgeSiftBytes; };
  const bool by_sift = !a.sift.empty() && !b.sift.empty();
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    const std::size_t i = row * static_cast<std::size_t>(row_step);
    for (auto c = static_cast<std::size_t>(candidates.first[row]);
         c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      scores.ncc[c] = patch_ncc(patch(a, i), patch(b, j));
      if (by_sift) scores.sift[c] = std::sqrt(static_cast<float>(sift_distance2(sift(a, i), sift(b, j))));
    }
  }
  decide(candidates, limits, scores);
  return scores;
}

}  // namespace quadedge::reference
