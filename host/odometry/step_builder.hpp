#pragma once
/// \file step_builder.hpp  Steps and their motion, for the hypotheses and for the confirmation.

#include <Eigen/Geometry>
#include <optional>
#include <utility>

#include "frontend/frontend.hpp"
#include "odometry/disparity_offset.hpp"
#include "odometry/motion_step.hpp"
#include "pose/motion.hpp"
#include "pose/quads.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Takes steps from a pool and finds the motion that their matches agree on. It must outlive the steps.
class StepBuilder {
 public:
  /// Refers to the offset, which must outlive it.
  StepBuilder(const Config& config, const DisparityOffset& offset) : config_(config), offset_(offset) {}

  /// A step from `base` without matches.
  StepHandle take(const frontend::RigHandle& base);

  /// The motion that the step's matches agree on. \param initial a hypothesis beside the samples, current_from_base
  void estimate(const MotionQuery& query, const PoseConfig& limits, const std::optional<Eigen::Isometry3d>& initial,
                MotionStep& step) {
    find_motion(query, limits, initial, pose::RefinementGoal::pose_and_covariance, step);
  }
  /// The same without what only a motion that was confirmed needs: covariance and offset.
  void propose(const MotionQuery& query, const PoseConfig& limits, const std::optional<Eigen::Isometry3d>& initial,
               MotionStep& step) {
    find_motion(query, limits, initial, pose::RefinementGoal::pose, step);
  }
  /// Time that both took since the last call [ms].
  double take_pose_ms() { return std::exchange(pose_ms_, 0); }

  /// The rig's edges, measured with the calibration as far as it is known.
  const pose::MeasuredEdges& measured(const frontend::Rig& rig) const;
  /// The calibration as far as it is known.
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

/// Limits for the motion of a few edges that an exact search is to confirm: it need not convince by itself.
PoseConfig limits_of_proposals(const Config& config);

}  // namespace quadedge::odometry
