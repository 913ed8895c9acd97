#include "motion/step_builder.hpp"

#include <algorithm>

#include "common/run_cost.hpp"
#include "motion/motion_constants.hpp"

namespace quadedge::motion {

StepHandle StepBuilder::take(const frontend::RigHandle& base) {
  StepHandle step = steps_.take();
  step->base = base;
  return step;
}

void StepBuilder::find_motion(const MotionQuery& query, const PoseConfig& limits,
                              const std::optional<Eigen::Isometry3d>& initial, pose::RefinementGoal goal,
                              MotionStep& step) {
  const auto start = Clock::now();
  quad_builder_.build(measured(*step.base), query.current->edges, measured(*query.current), step.matches,
                      pose::QuadLimits(config_), step.quads);
  step.quads.scoring.half_length =
      pose::QuadBuilder::half_length(std::max(step.base->edges_spacing, query.current->edges_spacing));
  estimator_.estimate(calibration(), step.quads, limits, query.seed, initial, offset_.variance(), step.motion, goal);
  pose_ms_ += milliseconds_since(start);
}

const pose::MeasuredEdges& StepBuilder::measured(const frontend::Rig& rig) const {
  return rig.measured_edges(calibration(), offset_.value(), config_.stereo.min_epipolar_angle_rad());
}

PoseConfig limits_of_proposals(const Config& config) {
  PoseConfig limits = config.pose;
  limits.min_inlier_ratio = kProposalMinInlierRatio;
  limits.min_spread = 0;
  return limits;
}

}  // namespace quadedge::motion
