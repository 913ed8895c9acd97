/// \file ransac.cpp  A pool that grows as in PROSAC, a preview of costs, and local optimisation (LO-RANSAC).
#include "motion/ransac.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "motion/two_quads.hpp"

namespace quadedge::pose {

namespace {

/// Indices of the non-zero bytes, ascending.
void mask_to_rows(const std::vector<std::uint8_t>& mask, std::vector<std::int32_t>& rows) {
  rows.clear();
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) rows.push_back(static_cast<std::int32_t>(i));
}

/// State of one run of find_consensus().
class Search {
 public:
  Search(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, std::uint64_t seed,
         ConsensusWorkspace& workspace, double disparity_error)
      : quads_(quads), rig_(rig), config_(config), noise_(config, disparity_error), random_(seed), work_(workspace) {
    const std::size_t scored = kScoringQuads, preview = kPreviewQuads;
    if (config.scoring_cell > 0) {
      balanced_subset(random_, quads.scoring, config.scoring_cell, scored, work_.subset, work_.scored_rows);
    } else {
      random_subset(random_, quads.size(), scored, work_.scored_rows);
    }
    auto &scored_rows = work_.scored_rows, &preview_rows = work_.preview_rows;
    preview_rows.assign(scored_rows.begin(),
                        scored_rows.begin() + static_cast<std::ptrdiff_t>(std::min(scored_rows.size(), preview)));
    for (auto [numbers, arrays] : {std::pair(&scored_rows, &work_.scored), std::pair(&preview_rows, &work_.preview)}) {
      work_.mask.assign(quads.size(), 0);
      for (std::int32_t row : *numbers) work_.mask[static_cast<std::size_t>(row)] = 1;
      mask_to_rows(work_.mask, *numbers);
      arrays->assign_rows(quads.scoring, *numbers);
    }
    work_.preview_terms.clear();
    if (config.local_optimisation_rounds > 0)
      for (std::int32_t row : preview_rows)
        work_.preview_terms.push_back(make_sample_term(quads, static_cast<std::size_t>(row), noise_, rig.left));
    const double diagonal = std::hypot(rig.left.width, rig.left.height);
    min_distance_squared_ = std::pow(kMinPairDistance * diagonal, 2);
  }

  Consensus run(const std::optional<Eigen::Isometry3d>& initial) {
    if (initial) consider(*initial);
    if (quads_.size() >= 2) sample();
    return best_;
  }

 private:
  void sample() {
    SamplingOrder order(quads_, work_.order);
    // The pool grows linearly over the first kMaxHypotheses draws, from the smallest useful subset to all quads.
    const double first_pool = std::min<double>(static_cast<double>(order.size()), config_.min_inliers);
    const double growth = (static_cast<double>(order.size()) - first_pool) / kMaxHypotheses;
    const double pairs = 0.5 * static_cast<double>(order.size()) * static_cast<double>(order.size() - 1);
    const double fewest = std::max(config_.min_inlier_ratio,
                                   config_.min_inliers / static_cast<double>(std::max<std::size_t>(1, order.size())));
    const double useful =
        std::max<double>(kMaxHypotheses, std::min(kDrawsPerPair * pairs, kDrawsForConsensus / (fewest * fewest)));
    const int max_draws = useful < config_.max_draws ? static_cast<int>(useful) : config_.max_draws;
    try_pairs(
        random_, best_.draws, work_.drawn,
        [&](int number) {
          const double pool_size = std::min(first_pool + growth * number, static_cast<double>(order.size()));
          const std::size_t pool = std::max<std::size_t>(2, static_cast<std::size_t>(pool_size));
          order.sort_first(pool);
          return pool;
        },
        [&](std::size_t a, std::size_t b, std::size_t block) { return solve(order[a], order[b], work_.pairs[block]); },
        [&] { return best_.draws >= max_draws || best_.hypotheses >= std::min(needed_, kMaxHypotheses); },
        [&](const Eigen::Isometry3d& motion) { consider(motion); });
  }

  std::optional<Eigen::Isometry3d> solve(std::size_t a, std::size_t b, PairWorkspace& work) const {
    const double dx = static_cast<double>(quads_.scoring.left_x[a]) - static_cast<double>(quads_.scoring.left_x[b]);
    const double dy = static_cast<double>(quads_.scoring.left_y[a]) - static_cast<double>(quads_.scoring.left_y[b]);
    if (dx * dx + dy * dy < min_distance_squared_) return std::nullopt;
    OrientedPair before{quads_.previous[a].oriented_point(), quads_.previous[b].oriented_point()};
    OrientedPair after{quads_.current[a].oriented_point(), quads_.current[b].oriented_point()};
    auto motion = solve_constrained(before, after);
    if (!motion || config_.local_optimisation_rounds == 0) return motion;
    work.terms[0] = make_sample_term(quads_, a, noise_, rig_.left);
    work.terms[1] = make_sample_term(quads_, b, noise_, rig_.left);
    Eigen::Isometry3d fitted = *motion;
    return fit_sample(work.terms, pair_rows_, config_, fitted, work.fit) ? fitted : *motion;
  }

  void consider(const Eigen::Isometry3d& motion) {
    ++best_.hypotheses;
    const double preview_cost = truncated_cost(work_.preview, LaterCameras(rig_, motion),
                                               config_.local_optimisation_widening * config_.inlier_distance);
    if (best_.found && preview_cost >= best_preview_cost_) return;
    best_preview_cost_ = preview_cost;
    accept(motion);
    if (config_.local_optimisation_rounds == 0) return;
    if (const auto better = optimise(motion)) accept(*better);
  }

  /// Fits over the inliers of the preview, with a distance that decreases geometrically to the inlier distance.
  std::optional<Eigen::Isometry3d> optimise(Eigen::Isometry3d motion) {
    const int rounds = config_.local_optimisation_rounds;
    for (int round = 0; round < rounds; ++round) {
      const double progress = rounds > 1 ? static_cast<double>(round) / (rounds - 1) : 1.0;
      const double distance = config_.inlier_distance * std::pow(config_.local_optimisation_widening, 1.0 - progress);
      select_inliers(work_.preview, LaterCameras(rig_, motion), distance, kInlierOrientation, work_.mask);
      mask_to_rows(work_.mask, work_.inlier_rows);
      if (!fit_sample(work_.preview_terms, work_.inlier_rows, config_, motion, work_.fit)) return std::nullopt;
    }
    return motion;
  }

  void accept(const Eigen::Isometry3d& motion) {
    const LaterCameras cameras(rig_, motion);
    const double cost = truncated_cost(work_.scored, cameras, config_.inlier_distance);
    if (best_.found && cost >= best_.cost) return;
    best_.found = true;
    best_.cost = cost;
    best_.current_from_previous = motion;
    const int inliers = select_inliers(work_.scored, cameras, config_.inlier_distance, kInlierOrientation, work_.mask);
    const double ratio = static_cast<double>(inliers) / static_cast<double>(work_.scored.size());
    const double miss = std::log1p(-std::min(ratio * ratio, 1.0 - std::numeric_limits<double>::epsilon()));
    const double draws = std::log1p(-kConfidence) / miss;
    needed_ =
        std::max(config_.min_hypotheses, draws < kMaxHypotheses ? static_cast<int>(std::ceil(draws)) : kMaxHypotheses);
  }

  const QuadObservations& quads_;
  const StereoRig& rig_;
  const PoseConfig& config_;
  NoiseModel noise_;
  std::mt19937_64 random_;
  ConsensusWorkspace& work_;
  const std::vector<std::int32_t> pair_rows_ = {0, 1};
  double min_distance_squared_ = 0;
  double best_preview_cost_ = 1;
  int needed_ = std::numeric_limits<int>::max();
  Consensus best_;
};

}  // namespace

Consensus find_consensus(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                         std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                         ConsensusWorkspace& workspace, double disparity_error) {
  return Search(quads, rig, config, seed, workspace, disparity_error).run(initial);
}

}  // namespace quadedge::pose
