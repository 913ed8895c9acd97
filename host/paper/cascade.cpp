#include "paper/cascade.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/matching_constants.hpp"
#include "common/numeric.hpp"
#include "common/parallel.hpp"
#include "reference/sift.hpp"

namespace quadedge::paper {
namespace {

/// The centroid and the weighted direction of some hypotheses.
Cluster represent(const std::vector<Hypothesis>& hypotheses, std::vector<std::size_t> members) {
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero(), direction = Eigen::Vector2d::Zero();
  for (const std::size_t m : members) centroid += hypotheses[m].position / static_cast<double>(members.size());
  const auto distance = [&](std::size_t m) { return (hypotheses[m].position - centroid).norm(); };
  for (const std::size_t m : members) {
    const auto angle = static_cast<double>(hypotheses[m].direction);
    direction +=
        std::exp(-0.5 * std::pow(distance(m) / kClusterSigma, 2)) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  std::stable_sort(members.begin(), members.end(),
                   [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  Cluster cluster;
  cluster.centre = {static_cast<float>(centroid.x()), static_cast<float>(centroid.y()),
                    static_cast<float>(std::atan2(direction.y(), direction.x()))};
  for (const std::size_t m : members) cluster.members.push_back(hypotheses[m].target);
  return cluster;
}

}  // namespace

Described describe(const ImageView& image, const Picture& picture, const EdgePositionsView& edges, double offset) {
  return {cut_sides(picture, edges, offset), reference::sift_descriptors(image, edges.x, edges.y, edges.direction)};
}

float line_angle_between(float a, float b) {
  const float angle = angle_between(a, b);
  return std::min(angle, static_cast<float>(kPi) - angle);
}

reference::CandidateScores judge(const reference::Candidates& candidates, const Described& a, const Described& b,
                                 const FilterLimits& limits, bool all_scores) {
  reference::CandidateScores scores;
  scores.ncc.resize(candidates.target.size());
  scores.sift.resize(candidates.target.size());
  for_row_blocks(candidates.first.size() - 1, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      for (auto c = static_cast<std::size_t>(candidates.first[i]);
           c < static_cast<std::size_t>(candidates.first[i + 1]); ++c) {
        const auto j = static_cast<std::size_t>(candidates.target[c]);
        scores.ncc[c] = best_pairing(a.patches[i], b.patches[j]).ncc;
        if (scores.ncc[c] < limits.ncc_min && !all_scores) continue;
        scores.sift[c] = std::sqrt(static_cast<float>(
            reference::sift_distance2(a.sift.data() + i * kEdgeSiftBytes, b.sift.data() + j * kEdgeSiftBytes)));
      }
    }
  });
  reference::decide(candidates, limits, scores);
  return scores;
}

std::vector<Cluster> clusters_of(const std::vector<Hypothesis>& hypotheses) {
  const std::size_t count = hypotheses.size();
  std::vector<std::size_t> cluster(count);  // of each hypothesis: the number of one of its members
  std::iota(cluster.begin(), cluster.end(), std::size_t{0});
  const auto size = [&](std::size_t number) { return std::count(cluster.begin(), cluster.end(), number); };
  /// The nearest hypothesis of another cluster that `i` may join; `count` if there is none.
  const auto partner = [&](std::size_t i) {
    std::size_t nearest = count;
    double shortest = kClusterGap;
    for (std::size_t j = 0; j < count; ++j) {
      const double distance = (hypotheses[i].position - hypotheses[j].position).norm();
      if (cluster[i] == cluster[j] || !(distance < shortest)) continue;
      if (angle_between(hypotheses[i].direction, hypotheses[j].direction) >= static_cast<float>(kClusterOrientation))
        continue;
      nearest = j;
      shortest = distance;
    }
    return nearest < count && size(cluster[i]) + size(cluster[nearest]) <= kClusterSizeMax ? nearest : count;
  };
  for (std::size_t i = 0; i < count;) {
    const std::size_t joined = partner(i);
    if (joined == count) {
      ++i;
      continue;
    }
    std::replace(cluster.begin(), cluster.end(), std::size_t{cluster[joined]}, std::size_t{cluster[i]});
    i = 0;
  }
  std::vector<Cluster> clusters;
  for (std::size_t number = 0; number < count; ++number) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < count; ++i)
      if (cluster[i] == number) members.push_back(i);
    if (!members.empty()) clusters.push_back(represent(hypotheses, std::move(members)));
  }
  return clusters;
}

}  // namespace quadedge::paper
