#pragma once
/// \file step_builder.hpp  Creates motion steps, for the hypotheses and for the confirmation.

#include <Eigen/Geometry>
#include <optional>
#include <utility>

#include "frontend/frontend.hpp"
#include "motion/disparity_offset.hpp"
#include "motion/motion_step.hpp"
#include "pose/motion.hpp"
#include "pose/quads.hpp"
#include "quadedge/config.hpp"

namespace quadedge::motion {

/// Takes steps from a pool and estimates the motion that their matches support. It must outlive the steps.
class StepBuilder {
 public:
  /// Refers to the offset, which must outlive the object.
  StepBuilder(const Config& config, const DisparityOffset& offset) : config_(config), offset_(offset) {}

  /// Returns a step from `base` without matches.
  StepHandle take(const frontend::RigHandle& base);

  /// Estimates the motion of the step's matches. \param initial a hypothesis besides the samples, current_from_base
  void estimate(const MotionQuery& query, const PoseConfig& limits, const std::optional<Eigen::Isometry3d>& initial,
                MotionStep& step) {
    find_motion(query, limits, initial, pose::RefinementGoal::pose_and_covariance, step);
  }
  /// The same without covariance and offset, which only a confirmed motion needs.
  void propose(const MotionQuery& query, const PoseConfig& limits, const std::optional<Eigen::Isometry3d>& initial,
               MotionStep& step) {
    find_motion(query, limits, initial, pose::RefinementGoal::pose, step);
  }
  /// Time spent in both since the last call [ms].
  double take_pose_ms() { return std::exchange(pose_ms_, 0); }

  /// The rig's edges, measured with calibration().
  const pose::MeasuredEdges& measured(const frontend::Rig& rig) const;
  /// The calibration, corrected by the disparity offset estimated so far.
  const StereoRig& calibration() const { return offset_.rig(); }

 private:
  void find_motion(const MotionQuery& query, const PoseConfig& limits, const std::optional<Eigen::Isometry3d>& initial,
                   pose::RefinementGoal goal, MotionStep& step);

  Config config_;
  const DisparityOffset& offset_;
  Pool<MotionStep> steps_;
  pose::QuadBuilder quad_builder_;
  pose::MotionEstimator estimator_;
  double pose_ms_ = 0;
};

/// Relaxed limits for the motion of a subset of the edges, to be confirmed by a guided search.
PoseConfig limits_of_proposals(const Config& config);

}  // namespace quadedge::motion
