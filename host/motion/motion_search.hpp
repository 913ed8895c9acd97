#pragma once
/// \file motion_search.hpp  Finds the motion of the current stereo edges since an earlier rig.

#include <memory>
#include <vector>

#include "frontend/frontend.hpp"
#include "motion/acceptance.hpp"
#include "motion/confirmation.hpp"
#include "motion/disparity_offset.hpp"
#include "motion/motion_elsewhere.hpp"
#include "motion/motion_hypothesis.hpp"
#include "motion/motion_step.hpp"
#include "motion/step_builder.hpp"
#include "motion/track_record.hpp"
#include "quadedge/config.hpp"

namespace quadedge::motion {

/// Tries motion hypotheses with growing effort. Each proposal, made from a subset of the edges, is confirmed with all
/// edges; select() chooses among the verdicts and says whether more has to be tried.
class MotionSearch {
 public:
  /// Refers to the front end and the offset, which must outlive the object.
  MotionSearch(const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset);

  /// Returns the motion of the query's current rig; its status says whether one was found. The search must outlive the
  /// handle. The same query gives the same result until remember() is called.
  StepHandle find(const MotionQuery& query);

  /// Takes note of the motion that was chosen for a frame: what is expected of the next frame depends on it.
  void remember(const MotionStep& found) { record_.remember(found); }

  /// See StepBuilder::take_pose_ms().
  double take_pose_ms() { return steps_.take_pose_ms(); }

 private:
  /// A hypothesis, its proposal and the result of the confirmation.
  struct Trial {
    MotionHypothesis* hypothesis = nullptr;
    /// `confirmed` is null if the status of the proposal is not ok, or if it led to the known motion.
    StepHandle proposed, confirmed;
    Verdict verdict;  ///< on the outcome

    bool is_confirmed() const { return confirmed && confirmed->ok(); }
    StepHandle& outcome() { return confirmed ? confirmed : proposed; }
    const MotionStep& outcome() const { return confirmed ? *confirmed : *proposed; }
  };
  using Trials = std::vector<Trial>;

  /// Appends the hypotheses up to a level of effort that are not among the trials yet and have a proposal.
  void try_out(Effort effort, const MotionQuery& query, Trials& trials);
  static Evidence evidence_of(const Trials& trials);
  /// The first confirmed motion with all of its inliers; null if there is none.
  static const MotionStep* known_motion(const Trials& trials);
  StepHandle nothing_tried(const MotionQuery& query);
  Selection choose(const MotionQuery& query, Trials& trials) const;
  Verdict verdict_of(const Trial& trial, const Evidence& evidence, const MotionQuery& query) const;

  StepBuilder steps_;
  Acceptance acceptance_;
  Confirmation confirmation_;
  MotionElsewhere elsewhere_;
  TrackRecord record_;
  std::vector<std::unique_ptr<MotionHypothesis>> hypotheses_;  ///< in the order in which they are tried
};

}  // namespace quadedge::motion
