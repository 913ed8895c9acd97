#pragma once
/// \file motion_search.hpp  Finds the motion of the current stereo edges since an earlier rig.

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

/// Tries motion hypotheses in turn. Each proposal, made from a subset of the edges, is confirmed with all edges; common
/// acceptance tests choose the result.
class MotionSearch {
 public:
  /// Refers to the front end and the offset, which must outlive the object.
  MotionSearch(const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset);

  /// Returns the motion of the query's current rig; its status says whether one was found. The search must outlive the
  /// handle. The same query gives the same result until remember() is called.
  StepHandle find(const MotionQuery& query);

  /// Takes note of the motion that was chosen for a frame: what is expected of the next frame depends on it.
  void remember(const MotionStep& found);

  /// See StepBuilder::take_pose_ms().
  double take_pose_ms() { return steps_.take_pose_ms(); }

 private:
  /// A hypothesis, its proposal and the result of the confirmation.
  struct Trial {
    const MotionHypothesis* hypothesis = nullptr;
    StepHandle proposed, confirmed;  ///< `confirmed` is null if the status of the proposal is not ok

    StepHandle& outcome() { return confirmed ? confirmed : proposed; }
  };
  Trial try_out(MotionHypothesis& hypothesis, const MotionQuery& query, Evidence& evidence);
  static Trial& best(std::vector<Trial>& trials);
  Trial& with_all_inliers(Trial& chosen, std::vector<Trial>& trials, const MotionQuery& query);
  /// Transform from the base of `other` to the base of `found`; one of them may be the key rig.
  static Eigen::Isometry3d base_from_base(const MotionStep& found, const MotionStep& other, const MotionQuery& query);
  /// Whether another confirmed motion could also be the camera's.
  bool has_competing_motion(Trial& chosen, std::vector<Trial>& trials, const MotionQuery& query);

  StepBuilder steps_;
  Acceptance acceptance_;
  bool in_doubt_ = false;  ///< whether the last motion, and hence the prediction from it, is ambiguous
  Confirmation confirmation_;
  std::vector<std::unique_ptr<MotionHypothesis>> hypotheses_;  ///< in the order in which they are tried
};

}  // namespace quadedge::odometry
