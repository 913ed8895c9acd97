/// \file paper_consensus.cpp  Draws pairs from the 70 % of quads with least competition; the most inliers win.
#include "motion/paper_consensus.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "common/parallel.hpp"
#include "motion/pose_constants.hpp"
#include "motion/sampling_order.hpp"
#include "motion/two_quads.hpp"

namespace quadedge::paper {

Eigen::Matrix3d align(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d v = from.cross(to);
  const double cosine = from.dot(to);
  if (cosine < 0) {
    // 1 / (1 + c) loses precision near a half turn. Prepending a half turn about the same axis leaves an angle below 90
    // degrees.
    const Eigen::Vector3d axis = v - v.dot(from) * from;
    const Eigen::Vector3d u =
        axis.norm() > 0 ? Eigen::Vector3d(axis.normalized()) : Eigen::Vector3d(from.unitOrthogonal());
    const Eigen::Matrix3d half_turn = 2.0 * u * u.transpose() - Eigen::Matrix3d::Identity();
    return align(-from, to) * half_turn;
  }
  Eigen::Matrix3d skew;
  skew << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return Eigen::Matrix3d::Identity() + skew + skew * skew / (1.0 + cosine);
}

Eigen::Isometry3d motion_of_one_quad(const pose::OrientedPoint& previous, const pose::OrientedPoint& current,
                                     double theta) {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  current_from_previous.linear() =
      Eigen::AngleAxisd(theta, current.tangent).toRotationMatrix() * align(previous.tangent, current.tangent);
  current_from_previous.translation() = current.point - current_from_previous.linear() * previous.point;
  return current_from_previous;
}

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
  static const pose::ConstraintLimits limits;
  pose::OrientedPair before{quads.previous[first].oriented_point(), quads.previous[second].oriented_point()};
  pose::OrientedPair after{quads.current[first].oriented_point(), quads.current[second].oriented_point()};
  const pose::ConstraintCheck check = pose::check_constraints(before, after, limits);
  if (!check.all()) return std::nullopt;
  if (check.swapped) {
    std::swap(before.first, before.second);
    std::swap(after.first, after.second);
  }
  auto motion = pose::solve_two_quads(before, after, limits.max_cosine);
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
  while (pool >= 2 && best.draws < config.max_draws && best.hypotheses < needed) {
    ++best.draws;
    const std::size_t a = pose::random_index(random, pool);
    std::size_t b = pose::random_index(random, pool - 1);
    if (b >= a) ++b;
    const auto motion = motion_of_two_quads(quads, order[a], order[b]);
    if (!motion) continue;
    ++best.hypotheses;
    const int inliers = find_inliers(quads, left, *motion, config.inlier_distance, inlier);
    if (best.current_from_previous && inliers <= best.inliers) continue;
    best.current_from_previous = motion;
    best.inliers = inliers;
    std::swap(best.inlier, inlier);
    needed = hypotheses_needed(static_cast<double>(inliers) / static_cast<double>(quads.size()), config);
  }
  return best;
}

}  // namespace quadedge::paper
