#pragma once
/// \file motion_search.hpp  From the current stereo edges to the motion since an earlier rig.

#include <memory>
#include <vector>

#include "frontend/frontend.hpp"
#include "odometry/acceptance.hpp"
#include "odometry/confirmation.hpp"
#include "odometry/disparity_offset.hpp"
#include "odometry/motion_hypothesis.hpp"
#include "odometry/motion_step.hpp"
#include "odometry/step_builder.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Tries motion hypotheses in turn: what one proposes with a part of the edges is confirmed with all of them, and one
/// acceptance test says what to believe.
class MotionSearch {
 public:
  /// Refers to the front end and to the offset, which must outlive it.
  MotionSearch(const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset);

  /// The motion of the query's current rig; its status says whether there is one. The search must outlive the handle.
  StepHandle find(const MotionQuery& query);

  /// See StepBuilder::take_pose_ms().
  double take_pose_ms() { return steps_.take_pose_ms(); }

 private:
  /// find() but for what is remembered of it.
  StepHandle search(const MotionQuery& query);

  /// A hypothesis, what it proposed and what the confirmation made of it.
  struct Trial {
    const MotionHypothesis* hypothesis = nullptr;
    StepHandle proposed, confirmed;  ///< there is no confirmation where the proposal is not ok

    StepHandle& outcome() { return confirmed ? confirmed : proposed; }
  };
  Trial try_out(MotionHypothesis& hypothesis, const MotionQuery& query, Evidence& evidence);
  static Trial& best(std::vector<Trial>& trials);
  Trial& with_all_inliers(Trial& chosen, std::vector<Trial>& trials, const MotionQuery& query);
  /// From the base of another step to that of the one found; one of them may be the key rig.
  static Eigen::Isometry3d base_from_base(const MotionStep& found, const MotionStep& other, const MotionQuery& query);
  /// Whether another motion that was confirmed could be the world's as well.
  bool has_competing_motion(Trial& chosen, std::vector<Trial>& trials, const MotionQuery& query);

  StepBuilder steps_;
  Acceptance acceptance_;
  bool in_doubt_ = false;  ///< the last motion was ambiguous, and so is a prediction by it
  Confirmation confirmation_;
  std::vector<std::unique_ptr<MotionHypothesis>> hypotheses_;  ///< in the order in which they are tried
};

}  // namespace quadedge::odometry
