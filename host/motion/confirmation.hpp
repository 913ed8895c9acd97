#pragma once
/// \file confirmation.hpp  Confirms a proposed motion with all edges.

#include <Eigen/Geometry>

#include "frontend/frontend.hpp"
#include "motion/acceptance.hpp"
#include "motion/motion_step.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// Matches all edges of a rig within a few pixels of the positions that a motion predicts, and repeats this with the
/// motion found until the predicted positions no longer change.
class Confirmation {
 public:
  /// Refers to all arguments except the configuration; they must outlive the object.
  Confirmation(const Config& config, frontend::Frontend& frontend, StepBuilder& steps, const Acceptance& acceptance)
      : config_(config), frontend_(frontend), steps_(steps), acceptance_(acceptance) {}

  /// Returns the motion since the key rig or, if that is not confirmed, since the base. \param current_from_base the
  /// proposed motion \param closely whether inliers have to lie within a third of the usual distance
  /// \param confident_support below it, the support by the base may replace that by the key rig
  /// \param known a motion that has been confirmed; null: none \returns null if the proposal leads to that motion
  StepHandle confirm(const MotionQuery& query, const Eigen::Isometry3d& current_from_base, bool closely,
                     double confident_support, const MotionStep* known);

  /// Confirms a motion with only those edges of the base that it brings to where `other` explains nothing.
  StepHandle confirm_beside(const MotionQuery& query, const Eigen::Isometry3d& current_from_base,
                            const ExplainedCells& other);

 private:
  /// What is known of other motions.
  struct Others {
    const MotionStep* known = nullptr;          ///< see confirm()
    const ExplainedCells* explained = nullptr;  ///< if not null, only edges where it explains nothing are matched
    bool must_compete = false;                  ///< whether a motion that explains much less than `known` is given up
  };
  StepHandle match(const MotionQuery& query, const frontend::RigHandle& base, const PoseConfig& limits,
                   Eigen::Isometry3d current_from_base, const Others& others);

  void take_support_of_base(const MotionQuery& query, const PoseConfig& limits, MotionStep& by_key);

  Config config_;
  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  const Acceptance& acceptance_;
  TemporalSearch search_, next_search_, known_search_;  ///< kept between calls
};

}  // namespace quadedge::motion
