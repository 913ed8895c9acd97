#pragma once
/// \file motion_elsewhere.hpp  Searches for another motion where the chosen one explains nothing.

#include "frontend/frontend.hpp"
#include "motion/acceptance.hpp"
#include "motion/confirmation.hpp"
#include "motion/motion_step.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// An object that fills much of the image may hold most of the edges, so that its motion is chosen with confidence. The
/// scene beside it moves too far to be found near that motion; it is searched for among the global matches.
class MotionElsewhere {
 public:
  /// Refers to all arguments except the configuration; they must outlive the object.
  MotionElsewhere(const Config& config, frontend::Frontend& frontend, StepBuilder& steps, Confirmation& confirmation,
                  const Acceptance& acceptance);

  /// \param global_matches of the query's base; null if none were computed
  /// \param thorough whether all of temporal.wide_edges take part if they have to be computed, which takes as long as
  /// the rest of the frame
  Elsewhere find(const MotionQuery& query, const MotionStep& chosen, const MotionStep* global_matches, bool thorough);

 private:
  Config config_;
  PoseConfig limits_;
  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  Confirmation& confirmation_;
  const Acceptance& acceptance_;
  TemporalMatches matches_;  ///< kept between calls
};

}  // namespace quadedge::motion
