#include "reference/temporal_quads.hpp"

#include <algorithm>
#include <cmath>

#include "common/matching_constants.hpp"
#include "common/numeric.hpp"

namespace quadedge::reference {
namespace {

/// Number of groups that chain up by position and direction: single linkage, flooding from every member without a
/// group.
int count_clusters(const std::vector<std::size_t>& members, const StereoEdges& edges) {
  std::vector<bool> reached(members.size(), false);
  int clusters = 0;
  for (std::size_t seed = 0; seed < members.size(); ++seed) {
    if (reached[seed]) continue;
    ++clusters;
    reached[seed] = true;
    std::vector<std::size_t> open = {members[seed]};
    while (!open.empty()) {
      const std::size_t a = open.back();
      open.pop_back();
      for (std::size_t m = 0; m < members.size(); ++m) {
        const std::size_t b = members[m];
        if (reached[m] ||
            std::hypot(edges.left_x[a] - edges.left_x[b], edges.left_y[a] - edges.left_y[b]) >= kClusterGap)
          continue;
        if (angle_between(edges.left_direction[a], edges.left_direction[b]) > kClusterOrientation) continue;
        reached[m] = true;
        open.push_back(b);
      }
    }
  }
  return clusters;
}

}  // namespace

std::vector<float> temporal_agreement(const Candidates& left_candidates, CandidateScores& left,
                                      const Candidates& right_candidates, const CandidateScores& right) {
  std::vector<float> agreement(left_candidates.target.size(), 0.0f);
  for (std::size_t row = 0; row + 1 < left_candidates.first.size(); ++row) {
    for (auto c = static_cast<std::size_t>(left_candidates.first[row]);
         c < static_cast<std::size_t>(left_candidates.first[row + 1]); ++c) {
      if (left.state[c] != kCandidateAlive) continue;
      bool found = false;
      for (auto d = static_cast<std::size_t>(right_candidates.first[row]);
           d < static_cast<std::size_t>(right_candidates.first[row + 1]) && !found; ++d) {
        if (right.state[d] != kCandidateAlive || right_candidates.target[d] != left_candidates.target[c]) continue;
        found = true;
        agreement[c] = 0.5f * (left.ncc[c] + right.ncc[d]);
      }
      if (!found) left.state[c] = static_cast<std::uint8_t>(order_of(TemporalFilter::agreement));
    }
  }
  return agreement;
}

TemporalMatches temporal_best(const Candidates& candidates, const CandidateScores& scores,
                              const std::vector<float>& agreement, const StereoEdges& current,
                              const TemporalConfig& config, const TemporalSearch& search) {
  const float distance_weight = static_cast<float>(config.distance_weight) / (search.radius * search.radius);
  TemporalMatches matches;
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    const std::size_t i = row * static_cast<std::size_t>(search.step);
    std::vector<std::size_t> alive;  // current edges
    std::size_t winner = 0;
    float highest = 0;
    for (auto c = static_cast<std::size_t>(candidates.first[row]);
         c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      const float dx = current.left_x[j] - search.left.x[i], dy = current.left_y[j] - search.left.y[i];
      const float weighed = agreement[c] - distance_weight * (dx * dx + dy * dy);
      if (alive.empty() || weighed > highest) {
        winner = c;
        highest = weighed;
      }
      alive.push_back(j);
    }
    if (alive.empty()) continue;
    matches.append(static_cast<std::int32_t>(i), candidates.target[winner], current, agreement[winner],
                   count_clusters(alive, current) - 1);
  }
  return matches;
}

}  // namespace quadedge::reference
