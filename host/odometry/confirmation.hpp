#pragma once
/// \file confirmation.hpp  What the matching of all edges says of a proposed motion.

#include <Eigen/Geometry>

#include "frontend/frontend.hpp"
#include "odometry/acceptance.hpp"
#include "odometry/motion_step.hpp"
#include "odometry/step_builder.hpp"

namespace quadedge::odometry {

/// Matches all edges of a rig within a few pixels of where a motion predicts them, again around what that finds until
/// the predicted positions stay.
class Confirmation {
 public:
  /// Refers to all but the configuration, which must outlive it.
  Confirmation(const Config& config, frontend::Frontend& frontend, StepBuilder& steps, Acceptance& acceptance)
      : config_(config), frontend_(frontend), steps_(steps), acceptance_(acceptance) {}

  /// The motion since the key rig or, where that one is out of sight, since the base. Little support by the key
  /// rig is made up for by the base's. \param current_from_base proposed
  /// \param closely inliers lie within a third of the usual distance
  StepHandle confirm(const MotionQuery& query, const Eigen::Isometry3d& current_from_base, bool closely = false);

 private:
  StepHandle match(const MotionQuery& query, const frontend::RigHandle& base, const PoseConfig& limits,
                   Eigen::Isometry3d current_from_base);

  void take_support_of_base(const MotionQuery& query, const PoseConfig& limits, MotionStep& by_key);

  Config config_;
  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  Acceptance& acceptance_;
  TemporalSearch search_, next_search_;  ///< kept for their memory
};

}  // namespace quadedge::odometry
