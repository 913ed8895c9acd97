#include "odometry/motion_search.hpp"

#include <algorithm>
#include <vector>

#include "odometry/prediction.hpp"

namespace quadedge::odometry {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr double kSettled = 0.3;  ///< mean distance of predicted places that calls for no further search [px]

}  // namespace

MotionStep MotionSearch::estimate(stages::Base base, const stages::TemporalSearch& search,
                                  const std::optional<Eigen::Isometry3d>& prediction, const PoseConfig& limits, std::uint64_t seed) const {
  const StereoRig& rig = offset_.rig();
  MotionStep step;
  step.base = base;
  step.matches = frontend_.match(base, search);
  step.quads = pose::build_quads(rig, frontend_.base(base), frontend_.current(), step.matches, pose::QuadLimits(config_));
  step.motion = pose::estimate_motion(rig, step.quads, limits, seed, prediction, offset_.variance());
  return step;
}

/// Looks for the motion since the previous rig with a part of the edges. What it suggests need not convince.
MotionStep MotionSearch::scout(const MotionPrior& prior, double radius) const {
  PoseConfig lenient = config_.pose;
  lenient.min_inlier_share = config_.temporal.scout_min_inlier_share;
  lenient.min_spread = 0;
  const StereoEdges& previous = frontend_.base(stages::Base::previous);
  const int every = std::max(1, static_cast<int>(previous.size()) / config_.temporal.scout_edges);
  auto search = predict_places(offset_.rig(), previous, prior.prediction, radius, every, config_.stereo.min_epipolar_angle * kDegree);
  search.scout = true;
  return estimate(stages::Base::previous, search, prior.prediction, lenient, prior.seed);
}

/// Matches all edges of a base within a few pixels of where a motion predicts them, again around what that finds until the places
/// stay. Within so few pixels a wrong motion finds some support too: a true one has to find more.
MotionStep MotionSearch::match(stages::Base base, Eigen::Isometry3d prediction, std::uint64_t seed) const {
  const auto places = [&](const Eigen::Isometry3d& motion) {
    return predict_places(offset_.rig(), frontend_.base(base), motion, config_.temporal.radius, 1,
                          config_.stereo.min_epipolar_angle * kDegree);
  };
  auto search = places(prediction);
  MotionStep step;
  for (int round = 0; round < config_.temporal.rounds; ++round) {
    step = estimate(base, search, prediction, config_.pose, seed);
    if (step.motion.status != pose::MotionStatus::ok) break;
    const int in_view = count_in_view(rig_.left, search.left);
    if (step.motion.inliers < config_.temporal.min_support * in_view) {
      step.motion.status = pose::MotionStatus::no_consensus;
      break;
    }
    prediction = step.motion.current_from_previous;
    auto next = places(prediction);
    if (mean_distance(search.left, next.left) < kSettled) break;
    search = std::move(next);
  }
  return step;
}

MotionStep MotionSearch::find(const MotionPrior& prior) const {
  std::vector<double> radii = {config_.temporal.scout_radius_wide * rig_.left.width,
                               config_.temporal.scout_radius_widest * rig_.left.width};
  if (prior.prediction) radii.insert(radii.begin(), config_.temporal.scout_radius);
  MotionStep step;
  for (const double radius : radii) {
    step = scout(prior, radius);
    if (step.motion.status != pose::MotionStatus::ok) continue;
    const Eigen::Isometry3d motion = step.motion.current_from_previous;
    step = match(stages::Base::key, motion * prior.previous_from_key, prior.seed);
    if (step.motion.status == pose::MotionStatus::ok) break;
    if (prior.previous_is_key) continue;
    step = match(stages::Base::previous, motion, prior.seed);
    if (step.motion.status == pose::MotionStatus::ok) break;
  }
  return step;
}

}  // namespace quadedge::odometry
