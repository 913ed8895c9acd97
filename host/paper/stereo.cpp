#include "paper/stereo.hpp"

#include <algorithm>
#include <cmath>

#include "common/matching_constants.hpp"
#include "common/parallel.hpp"

namespace quadedge::paper {
namespace {

/// Filters 1 to 3.
reference::Candidates near_lines(const EdgeSet& left, const EdgeSet& right, const EpipolarGeometry& geometry) {
  const reference::Candidates all =
      reference::stereo_candidates(left, right, without_limits(geometry, false, true), {});
  reference::Candidates similar;
  similar.first.push_back(0);
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (auto c = static_cast<std::size_t>(all.first[i]); c < static_cast<std::size_t>(all.first[i + 1]); ++c) {
      const auto j = static_cast<std::size_t>(all.target[c]);
      if (line_angle_between(left.direction[i], right.direction[j]) <= geometry.orientation)
        similar.target.push_back(all.target[c]);
    }
    similar.first.push_back(static_cast<std::int32_t>(similar.target.size()));
  }
  return similar;
}

/// Filters 8 and 9 for one left edge.
class Row {
 public:
  Row(const View& left, const View& right, const EpipolarGeometry& geometry, const StereoConfig& config, double offset,
      std::size_t i)
      : left_(left.described.patches[i]),
        direction_(left.edges.direction[i]),
        fixed_(cut_sides(left.picture, {left.edges.x[i], left.edges.y[i], direction_}, kRefinementOffset)),
        right_(right),
        settings_(refinement_settings(config)),
        offset_(offset),
        line_(epipolar_line(geometry, left.edges.x[i], left.edges.y[i])) {}

  /// The candidate moved along its tangent onto the line, then refined along the line.
  Hypothesis refined(std::int32_t target) const {
    const auto j = static_cast<std::size_t>(target);
    const EdgeSet& edges = right_.edges;
    const double s = reference::epipolar_shift(line_, static_cast<double>(edges.x[j]), static_cast<double>(edges.y[j]),
                                               static_cast<double>(edges.direction[j]), kShiftMinAngle, kShiftMax);
    // Patches have the left edge's direction in both images; the most similar pair may be of reversed contrast, for
    // which the right one is turned.
    const Place start{static_cast<float>(line_.x + s * line_.ex), static_cast<float>(line_.y + s * line_.ey),
                      direction_};
    const Eigen::Vector2d along(line_.ex, line_.ey);
    if (settings_.both_sides)
      return {refine(fixed_, kBothSides, right_.picture, start, along, settings_).position, edges.direction[j], target};
    const bool reversed = angle_between(direction_, edges.direction[j]) > static_cast<float>(kPi) / 2;
    const Place turned{start.x, start.y, direction_ + (reversed ? static_cast<float>(kPi) : 0.0F)};
    const Pairing pairing = best_pairing(left_, right_.described.patches[j]);
    return {refine(fixed_, {pairing}, right_.picture, turned, along, settings_).position, edges.direction[j], target};
  }

  void add(const Cluster& cluster, reference::StereoClusters& clusters) const {
    const auto x = static_cast<double>(cluster.centre.x - line_.x), y = static_cast<double>(cluster.centre.y - line_.y);
    clusters.position.push_back(x * line_.ex + y * line_.ey);
    clusters.direction.push_back(static_cast<double>(cluster.centre.direction));
    clusters.anchor.push_back(cluster.members.front());
    clusters.similarity.push_back(
        static_cast<double>(best_pairing(left_, cut_sides(right_.picture, cluster.centre, offset_)).ncc));
  }

 private:
  const SidePatches& left_;
  float direction_;
  SidePatches fixed_;  ///< of the left edge, for the refinement
  const View& right_;
  RefinementSettings settings_;
  double offset_;
  EpipolarLine line_;
};

void append(const reference::StereoClusters& more, reference::StereoClusters& clusters) {
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(clusters.position, more.position);
  add(clusters.direction, more.direction);
  add(clusters.anchor, more.anchor);
  add(clusters.similarity, more.similarity);
  clusters.first.push_back(static_cast<std::int32_t>(clusters.position.size()));
}

}  // namespace

StereoMatching match_stereo(const View& left, const View& right, const EpipolarGeometry& geometry,
                            const StereoConfig& config, double patch_offset, bool all_scores) {
  StereoMatching matching;
  matching.candidates = near_lines(left.edges, right.edges, geometry);
  matching.scores = judge(matching.candidates, left.described, right.described, stereo_limits(config), all_scores);
  std::vector<reference::StereoClusters> rows(left.edges.size());
  for_row_blocks(rows.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Row row(left, right, geometry, config, patch_offset, i);
      std::vector<Hypothesis> hypotheses;
      for (auto c = static_cast<std::size_t>(matching.candidates.first[i]);
           c < static_cast<std::size_t>(matching.candidates.first[i + 1]); ++c)
        if (matching.scores.state[c] == kCandidateAlive)
          hypotheses.push_back(row.refined(matching.candidates.target[c]));
      for (const Cluster& cluster : clusters_of(hypotheses)) row.add(cluster, rows[i]);
    }
  });
  matching.clusters.first.push_back(0);
  for (const auto& row : rows) append(row, matching.clusters);
  const std::vector<double>& similarity = matching.clusters.similarity;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::int32_t best = -1;
    double highest = config.refined_ncc_min;
    for (std::int32_t k = matching.clusters.first[i]; k < matching.clusters.first[i + 1]; ++k) {
      if (!(similarity[static_cast<std::size_t>(k)] >= highest)) continue;
      if (best >= 0 && similarity[static_cast<std::size_t>(k)] == highest) continue;
      best = k;
      highest = similarity[static_cast<std::size_t>(k)];
    }
    matching.chosen.push_back(best);
  }
  return matching;
}

StereoEdges stereo_edges(const StereoMatching& matching, const EdgeSet& left, const EpipolarGeometry& geometry) {
  StereoEdges edges;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (matching.chosen[i] < 0) continue;
    const auto k = static_cast<std::size_t>(matching.chosen[i]);
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    edges.left_index.push_back(static_cast<std::int32_t>(i));
    edges.right_index.push_back(matching.clusters.anchor[k]);
    edges.left_x.push_back(left.x[i]);
    edges.left_y.push_back(left.y[i]);
    edges.left_direction.push_back(left.direction[i]);
    edges.right_x.push_back(static_cast<float>(line.x + matching.clusters.position[k] * line.ex));
    edges.right_y.push_back(static_cast<float>(line.y + matching.clusters.position[k] * line.ey));
    edges.right_direction.push_back(static_cast<float>(matching.clusters.direction[k]));
    edges.ncc.push_back(static_cast<float>(matching.clusters.similarity[k]));
  }
  return edges;
}

}  // namespace quadedge::paper
