#include "reference/stereo_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "common/angles.hpp"
#include "common/stereo_constants.hpp"

namespace quadedge::reference {

StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores,
                               const RefinedCandidates& refined, const EdgeSet& right, const StereoConfig& config) {
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
    // A represented candidate comes behind every alive one.
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
             positions[members[to]] - positions[members[to - 1]] < config.cluster_gap &&
             angle_between(direction(members[to]), direction(members[to - 1])) <= config.cluster_orientation_rad()) {
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

std::vector<std::int32_t> stereo_best(const StereoClusters& clusters, const StereoConfig& config) {
  std::vector<std::int32_t> best(clusters.first.size() - 1, -1);
  for (std::size_t i = 0; i < best.size(); ++i) {
    for (std::int32_t k = clusters.first[i]; k < clusters.first[i + 1]; ++k) {
      const double similarity = clusters.similarity[static_cast<std::size_t>(k)];
      if (similarity < config.refined_ncc_min) continue;
      if (best[i] < 0 || similarity > clusters.similarity[static_cast<std::size_t>(best[i])]) best[i] = k;
    }
  }
  return best;
}

StereoEdges stereo_mutual(const StereoClusters& clusters, const std::vector<std::int32_t>& best, const EdgeSet& left,
                          const EpipolarGeometry& geometry, const StereoConfig& config) {
  std::map<std::int32_t, std::size_t> owner;  // right edge -> its best left edge
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const auto c = static_cast<std::size_t>(best[i]);
    const auto [entry, is_new] = owner.emplace(clusters.anchor[c], i);
    if (!is_new && clusters.similarity[c] > clusters.similarity[static_cast<std::size_t>(best[entry->second])])
      entry->second = i;
  }
  StereoEdges edges;
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const auto c = static_cast<std::size_t>(best[i]);
    const std::size_t rival = owner.at(clusters.anchor[c]);
    if (std::hypot(left.x[rival] - left.x[i], left.y[rival] - left.y[i]) > config.mutual_radius) continue;
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    edges.left_index.push_back(static_cast<std::int32_t>(i));
    edges.right_index.push_back(clusters.anchor[c]);
    edges.left_x.push_back(left.x[i]);
    edges.left_y.push_back(left.y[i]);
    edges.left_direction.push_back(left.direction[i]);
    edges.right_x.push_back(static_cast<float>(line.x + clusters.position[c] * line.ex));
    edges.right_y.push_back(static_cast<float>(line.y + clusters.position[c] * line.ey));
    edges.right_direction.push_back(static_cast<float>(clusters.direction[c]));
    edges.ncc.push_back(static_cast<float>(clusters.similarity[c]));
  }
  return edges;
}

}  // namespace quadedge::reference
