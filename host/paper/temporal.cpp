#include "paper/temporal.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/matching_constants.hpp"
#include "common/parallel.hpp"
#include "reference/point_index.hpp"

namespace quadedge::paper {
namespace {

/// Residual above which a refined position is not taken over [grey levels]; the code's.
constexpr double kLargestResidual = 6.0;

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
  if (found.rms <= kLargestResidual) hypothesis.position = found.position;
  return hypothesis;
}

}  // namespace

reference::Candidates near_previous(const StereoEdgesInView& before, const StereoEdgesInView& now, double radius,
                                    double orientation) {
  const auto reach = static_cast<float>(radius), most = static_cast<float>(orientation);
  reference::PointIndex index;
  reference::make_point_index(now.edges.x, now.edges.y, now.width, now.height, index);
  std::vector<std::vector<std::int32_t>> rows(before.edges.size());
  for_row_blocks(rows.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Place from = place_of(before.edges, i);
      index.visit_square(from.x, from.y, reach, [&](std::int32_t number) {
        const auto j = static_cast<std::size_t>(number);
        const float dx = now.edges.x[j] - from.x, dy = now.edges.y[j] - from.y;
        if (dx * dx + dy * dy <= reach * reach && line_angle_between(now.edges.direction[j], from.direction) <= most)
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
  matching.candidates = near_previous(before, now, config.radius, kTemporalOrientation);
  matching.scores =
      judge(matching.candidates, before.described, now.described, temporal_limits(config, {}), all_scores);
  matching.clusters.resize(before.edges.size());
  for_row_blocks(matching.clusters.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SidePatches fixed = cut_sides(before.picture, place_of(before.edges, i), kRefinementOffset);
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

std::vector<Quad> close_loop(const std::vector<Cluster>& left, const std::vector<Cluster>& right) {
  std::vector<Quad> quads;
  for (std::size_t l = 0; l < left.size(); ++l) {
    for (std::size_t r = 0; r < right.size(); ++r) {
      const auto& others = right[r].members;
      const auto shared = std::find_if(left[l].members.begin(), left[l].members.end(), [&](std::int32_t edge) {
        return std::find(others.begin(), others.end(), edge) != others.end();
      });
      if (shared != left[l].members.end()) quads.push_back({l, r, *shared});
    }
  }
  return quads;
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
