/// \file cascades.cpp  The filters of both tables in order; refined candidates are clustered by agglomeration.
#include "paper/cascades.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/matching_constants.hpp"
#include "common/numeric.hpp"
#include "common/parallel.hpp"
#include "reference/edge_descriptions.hpp"
#include "reference/temporal_matching.hpp"

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
  // Both members of a pair are equally far away: rounding must not order them.
  const auto steps_away = [&](std::size_t m) {
    return std::lround(distance(m) / static_cast<double>(kClusterDistanceStep));
  };
  std::stable_sort(members.begin(), members.end(),
                   [&](std::size_t a, std::size_t b) { return steps_away(a) < steps_away(b); });
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
        fixed_(cut_sides(left.picture, {left.edges.x[i], left.edges.y[i], direction_}, kPaperRefinementOffset)),
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
    reference::append(left, i, matching.clusters, static_cast<std::size_t>(matching.chosen[i]), geometry, edges);
  }
  return edges;
}

namespace {

Place place_of(const EdgePositionsView& edges, std::size_t i) { return {edges.x[i], edges.y[i], edges.direction[i]}; }

/// Candidate j, moved freely in the image. \param fixed of the previous edge, for the refinement
Hypothesis refined(const StereoEdgesInView& before, std::size_t i, const SidePatches& fixed,
                   const StereoEdgesInView& now, std::size_t j, const RefinementSettings& settings) {
  const Place start = place_of(now.edges, j);
  const std::vector<Pairing> pairings =
      settings.both_sides ? kBothSides
                          : std::vector{best_pairing(before.described.patches[i], now.described.patches[j])};
  const Refined found = refine(fixed, pairings, now.picture, start, Eigen::Matrix2d::Identity(), settings);
  Hypothesis hypothesis{
      {static_cast<double>(start.x), static_cast<double>(start.y)}, start.direction, static_cast<std::int32_t>(j)};
  if (found.rms <= kPaperLargestResidual) hypothesis.position = found.position;
  return hypothesis;
}

}  // namespace

reference::Candidates near_previous(const EdgePositionsView& before, const EdgePositionsView& now, int width,
                                    int height, double radius, double orientation) {
  const auto reach = static_cast<float>(radius), most = static_cast<float>(orientation);
  reference::PointIndex index;
  reference::make_point_index(now.x, now.y, width, height, index);
  std::vector<std::vector<std::int32_t>> rows(before.size());
  for_row_blocks(rows.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Place from = place_of(before, i);
      index.visit_square(from.x, from.y, reach, [&](std::int32_t number) {
        const auto j = static_cast<std::size_t>(number);
        const float dx = now.x[j] - from.x, dy = now.y[j] - from.y;
        if (dx * dx + dy * dy <= reach * reach && line_angle_between(now.direction[j], from.direction) <= most)
          rows[i].push_back(number);
      });
    }
  });
  reference::Candidates candidates;
  candidates.first.push_back(0);
  for (const auto& row : rows) {
    candidates.target.insert(candidates.target.end(), row.begin(), row.end());
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
  }
  return candidates;
}

SideMatching match_side(const StereoEdgesInView& before, const StereoEdgesInView& now, const TemporalConfig& config,
                        const RefinementSettings& settings, bool all_scores) {
  SideMatching matching;
  matching.candidates =
      near_previous(before.edges, now.edges, now.width, now.height, config.radius, kTemporalOrientation);
  matching.scores =
      judge(matching.candidates, before.described, now.described, temporal_limits(config, {}), all_scores);
  matching.clusters.resize(before.edges.size());
  for_row_blocks(matching.clusters.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SidePatches fixed = cut_sides(before.picture, place_of(before.edges, i), kPaperRefinementOffset);
      std::vector<Hypothesis> hypotheses;
      for (auto c = static_cast<std::size_t>(matching.candidates.first[i]);
           c < static_cast<std::size_t>(matching.candidates.first[i + 1]); ++c)
        if (matching.scores.state[c] == kCandidateAlive)
          hypotheses.push_back(
              refined(before, i, fixed, now, static_cast<std::size_t>(matching.candidates.target[c]), settings));
      matching.clusters[i] = clusters_of(hypotheses);
    }
  });
  return matching;
}

TemporalMatches quads_of(const SideMatching& left, const SideMatching& right) {
  TemporalMatches matches;
  const auto ncc_of = [](const SideMatching& side, std::size_t row, std::int32_t edge) {
    const auto begin = side.candidates.target.begin() + side.candidates.first[row],
               end = side.candidates.target.begin() + side.candidates.first[row + 1];
    return side.scores.ncc[static_cast<std::size_t>(std::find(begin, end, edge) - side.candidates.target.begin())];
  };
  for (std::size_t i = 0; i < left.clusters.size(); ++i) {
    matches.alive_left += left.clusters[i].empty() ? 0 : 1;
    matches.alive_right += right.clusters[i].empty() ? 0 : 1;
    const std::vector<Quad> quads = close_loop(left.clusters[i], right.clusters[i]);
    for (const Quad& quad : quads) {
      const Place &in_left = left.clusters[i][quad.left].centre, &in_right = right.clusters[i][quad.right].centre;
      matches.previous.push_back(static_cast<std::int32_t>(i));
      matches.current.push_back(quad.edge);
      matches.left_x.push_back(in_left.x);
      matches.left_y.push_back(in_left.y);
      matches.left_direction.push_back(in_left.direction);
      matches.right_x.push_back(in_right.x);
      matches.right_y.push_back(in_right.y);
      matches.right_direction.push_back(in_right.direction);
      matches.ncc.push_back(0.5F * (ncc_of(left, i, quad.edge) + ncc_of(right, i, quad.edge)));
      matches.competing_clusters.push_back(static_cast<std::int32_t>(quads.size()) - 1);
    }
  }
  return matches;
}

}  // namespace quadedge::paper
