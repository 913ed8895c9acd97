/// \file motion.cpp  Consensus, then refinement over all inliers; refuses few quads, few inliers and a small spread.
#include "motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/pose_constants.hpp"

namespace quadedge::pose {

namespace {

/// Standard deviation of the inliers' current left positions over both axes, divided by the image diagonal.
double spread(const QuadObservations& quads, const std::vector<std::uint8_t>& inlier, const PinholeCamera& camera) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < inlier.size(); ++i) {
    if (!inlier[i]) continue;
    const Eigen::Vector2d position(static_cast<double>(quads.scoring.left_x[i]),
                                   static_cast<double>(quads.scoring.left_y[i]));
    sum += position;
    squares += position.squaredNorm();
    count += 1;
  }
  if (!(count > 0)) return 0;
  const double variance = squares / count - (sum / count).squaredNorm();
  return std::sqrt(std::max(variance, 0.0)) / std::hypot(camera.width, camera.height);
}

}  // namespace

Refusal MotionEstimator::estimate(const StereoRig& rig, const QuadObservations& quads, const PoseConfig& config,
                                  std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                                  const OffsetPrior& offset, MotionEstimate& motion, RefinementGoal goal) {
  std::vector<std::uint8_t> inlier = std::move(motion.inlier);
  motion = {};
  motion.inlier = std::move(inlier);
  motion.inlier.assign(quads.size(), 0);
  if (quads.size() < static_cast<std::size_t>(config.min_inliers)) return Refusal::too_few_quads;

  const Consensus consensus = find_consensus(quads, rig, config, seed, initial, consensus_, offset.error);
  if (!consensus.found) return Refusal::no_consensus;

  motion.current_from_previous = motion.learned.current_from_previous = consensus.current_from_previous;
  bool solved = true;
  if (config.refine) {
    solved = refine(quads, rig, config, offset, refinement_, motion, goal);
  } else {
    motion.inliers = select_inliers(quads.scoring, LaterCameras(rig, motion.current_from_previous),
                                    config.inlier_distance, kInlierOrientation, motion.inlier);
  }
  Refusal refusal = Refusal::none;
  if (!motion.has_consensus(config)) {
    refusal = Refusal::no_consensus;
  } else if (!solved || !motion.current_from_previous.matrix().allFinite() ||
             !motion.learned.current_from_previous.matrix().allFinite() || !motion.learned.covariance.allFinite() ||
             spread(quads, motion.inlier, rig.left) < config.min_spread) {
    refusal = Refusal::badly_spread;
  }
  if (refusal != Refusal::none) {
    motion.current_from_previous.setIdentity();
    motion.learned = {};
  }
  return refusal;
}

}  // namespace quadedge::pose
