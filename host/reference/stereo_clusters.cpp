#include "reference/stereo_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/matching_constants.hpp"
#include "common/numeric.hpp"

namespace quadedge::reference {

StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores,
                               const RefinedCandidates& refined, const EdgeSet& right) {
  const auto& positions = refined.position;
  StereoClusters clusters;
  clusters.first.assign(1, 0);
  for (std::size_t i = 0; i + 1 < candidates.first.size(); ++i) {
    std::vector<std::size_t> members;
    for (auto c = static_cast<std::size_t>(candidates.first[i]); c < static_cast<std::size_t>(candidates.first[i + 1]);
         ++c) {
      if (scores.state[c] == kCandidateAlive || scores.state[c] == kCandidateRepresented) members.push_back(c);
    }
    std::stable_sort(members.begin(), members.end(),
                     [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
    // Alive candidates come before represented ones.
    const auto rank = [&](std::size_t c) {
      const bool represented = scores.state[c] == kCandidateRepresented;
      return represented ? refined.similarity[c] - kBehindAll : refined.similarity[c];
    };
    const auto direction = [&](std::size_t c) {
      return right.direction[static_cast<std::size_t>(candidates.target[c])];
    };
    for (std::size_t from = 0, to = 0; from < members.size(); from = to) {
      to = from + 1;
      while (to < members.size() && static_cast<int>(to - from) < kClusterSizeMax &&
             positions[members[to]] - positions[members[to - 1]] < kClusterGap &&
             angle_between(direction(members[to]), direction(members[to - 1])) <= kClusterOrientation) {
        ++to;
      }
      double highest = rank(members[from]);
      for (std::size_t k = from; k < to; ++k) highest = std::max(highest, rank(members[k]));
      std::optional<std::size_t> chosen;
      for (std::size_t k = from; k < to; ++k) {
        const bool equal = rank(members[k]) >= highest - kSimilarityTie;
        if (equal && (!chosen || candidates.target[members[k]] < candidates.target[*chosen])) chosen = members[k];
      }
      double cosine = 0, sine = 0;
      for (std::size_t k = from; k < to; ++k) {
        const double weight =
            std::exp(-0.5 * std::pow((positions[members[k]] - positions[*chosen]) / kClusterSigma, 2));
        cosine += weight * std::cos(static_cast<double>(direction(members[k])));
        sine += weight * std::sin(static_cast<double>(direction(members[k])));
      }
      clusters.position.push_back(positions[*chosen]);
      clusters.direction.push_back(std::atan2(sine, cosine));
      clusters.anchor.push_back(candidates.target[*chosen]);
      clusters.similarity.push_back(rank(*chosen));
    }
    clusters.first.push_back(static_cast<std::int32_t>(clusters.position.size()));
  }
  return clusters;
}

}  // namespace quadedge::reference
