/// \file paper_consensus.cpp  Draws pairs from the 70 % of quads with least competition; the most inliers win.
#include "motion/paper_consensus.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "common/parallel.hpp"
#include "motion/pair_search.hpp"
#include "motion/pose_constants.hpp"
#include "motion/two_quads.hpp"

namespace quadedge::paper {

namespace {

/// The code's: part of the ranked quads from which pairs are drawn, probability of success, factor on the number of
/// hypotheses, and the largest number.
constexpr double kPool = 0.7, kSuccess = 0.97, kFactor = 3;
constexpr int kMostHypotheses = 5000;

int hypotheses_needed(double inlier_ratio, const PoseConfig& config) {
  const double wanted = kFactor * std::log1p(-kSuccess) / std::log1p(-inlier_ratio * inlier_ratio);
  return std::max(config.min_hypotheses,
                  wanted < kMostHypotheses ? static_cast<int>(std::ceil(wanted)) : kMostHypotheses);
}

}  // namespace

std::optional<Eigen::Isometry3d> motion_of_two_quads(const pose::QuadObservations& quads, std::size_t first,
                                                     std::size_t second) {
  pose::OrientedPair before{quads.previous[first].oriented_point(), quads.previous[second].oriented_point()};
  pose::OrientedPair after{quads.current[first].oriented_point(), quads.current[second].oriented_point()};
  auto motion = pose::solve_constrained(before, after);
  if (motion) motion->translation() = after.first.point - motion->linear() * before.first.point;
  return motion;
}

int find_inliers(const pose::QuadObservations& quads, const PinholeCamera& left,
                 const Eigen::Isometry3d& current_from_previous, double distance, std::vector<std::uint8_t>& inlier) {
  inlier.assign(quads.size(), 0);
  for_row_blocks(quads.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const pose::StereoMeasurement& before = quads.previous[q];
      const Eigen::Vector3d point = current_from_previous * (before.ray / before.inverse_depth);
      if (!(point.z() > 0)) continue;
      const Eigen::Vector2d seen(static_cast<double>(quads.scoring.left_x[q]),
                                 static_cast<double>(quads.scoring.left_y[q]));
      if (!((left.project(point) - seen).norm() < distance)) continue;
      const auto edge = pose::project(left, current_from_previous, before.oriented_point());
      const double cosine = edge ? edge->direction.dot(quads.current[q].left_edge.cast<double>()) : 0;
      inlier[q] = std::abs(cosine) > std::cos(pose::kInlierOrientation) ? 1 : 0;
    }
  });
  return static_cast<int>(std::count(inlier.begin(), inlier.end(), 1));
}

PaperConsensus find_paper_consensus(const pose::QuadObservations& quads, const PinholeCamera& left,
                                    const PoseConfig& config, std::uint64_t seed) {
  std::vector<std::size_t> order(quads.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return quads.competing_clusters[a] < quads.competing_clusters[b];
  });
  const auto pool = static_cast<std::size_t>(kPool * static_cast<double>(order.size()));
  PaperConsensus best;
  best.inlier.assign(quads.size(), 0);
  std::mt19937_64 random(seed);
  std::vector<std::uint8_t> inlier;
  int needed = kMostHypotheses;
  std::vector<pose::PairSample> drawn;
  pose::try_pairs(
      random, best.draws, drawn, [&](int) { return pool; },
      [&](std::size_t a, std::size_t b, std::size_t) { return motion_of_two_quads(quads, order[a], order[b]); },
      [&] { return pool < 2 || best.draws >= config.max_draws || best.hypotheses >= needed; },
      [&](const Eigen::Isometry3d& motion) {
        ++best.hypotheses;
        const int inliers = find_inliers(quads, left, motion, config.inlier_distance, inlier);
        if (best.current_from_previous && inliers <= best.inliers) return;
        best.current_from_previous = motion;
        best.inliers = inliers;
        std::swap(best.inlier, inlier);
        needed = hypotheses_needed(static_cast<double>(inliers) / static_cast<double>(quads.size()), config);
      });
  return best;
}

}  // namespace quadedge::paper
