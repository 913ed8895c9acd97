#include "pose/motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pose/pose_constants.hpp"

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

void MotionEstimator::estimate(const StereoRig& rig, const QuadObservations& quads, const PoseConfig& config,
                               std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                               double offset_variance, MotionEstimate& estimate, RefinementGoal goal) {
  std::vector<std::uint8_t> inlier = std::move(estimate.inlier);
  estimate = {};
  estimate.inlier = std::move(inlier);
  estimate.inlier.assign(quads.size(), 0);
  if (quads.size() < static_cast<std::size_t>(config.min_inliers)) return;

  estimate.status = MotionStatus::no_consensus;
  const Consensus consensus = find_consensus(quads, rig, config, seed, initial, consensus_);
  estimate.hypotheses = consensus.hypotheses;
  estimate.draws = consensus.draws;
  if (!consensus.found) return;

  Eigen::Isometry3d pose = consensus.current_from_previous;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  bool solved = true;
  if (config.refine) {
    const Refined refined = refine(quads, rig, config, pose, offset_variance, refinement_, estimate.inlier, goal);
    pose = refined.current_from_previous;
    covariance = refined.covariance;
    solved = refined.solved;
    estimate.offset = refined.offset;
    estimate.learned = refined.learned;
    estimate.inliers = refined.inliers;
  } else {
    estimate.inliers = select_inliers(quads.scoring, LaterCameras(rig, pose), config.inlier_distance,
                                      kInlierOrientation, estimate.inlier);
  }
  estimate.inlier_ratio = static_cast<double>(estimate.inliers) / static_cast<double>(quads.size());
  if (estimate.inliers < config.min_inliers || estimate.inlier_ratio < config.min_inlier_ratio) return;
  const Eigen::Isometry3d adopted = estimate.learned ? estimate.learned->current_from_previous : pose;
  const bool is_finite = pose.matrix().allFinite() && covariance.allFinite() && adopted.matrix().allFinite() &&
                         (!estimate.learned || estimate.learned->covariance.allFinite());
  if (!solved || !is_finite || spread(quads, estimate.inlier, rig.left) < config.min_spread) {
    estimate.status = MotionStatus::badly_spread;
    return;
  }
  estimate.status = MotionStatus::ok;
  estimate.current_from_previous = pose;
  estimate.covariance = std::move(covariance);
}

}  // namespace quadedge::pose
