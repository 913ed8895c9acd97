#pragma once
/// \file motion_elsewhere.hpp  Searches for another motion where the chosen one explains nothing.

#include "frontend/frontend.hpp"
#include "motion/acceptance.hpp"
#include "motion/confirmation.hpp"
#include "motion/motion_step.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// An object that fills much of the image may hold most of the edges, so that its motion is chosen with confidence. The
/// scene beside it moves too far to be found near that motion. It is searched for by matching globally the edges in the
/// cells that the chosen motion does not explain; the base's edges count where the chosen motion predicts them.
class MotionElsewhere {
 public:
  /// Refers to all arguments except the configuration; they must outlive the object.
  MotionElsewhere(const Config& config, frontend::Frontend& frontend, StepBuilder& steps, Confirmation& confirmation,
                  const Acceptance& acceptance);

  Elsewhere find(const MotionQuery& query, const MotionStep& chosen);

 private:
  Config config_;
  PoseConfig limits_;
  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  Confirmation& confirmation_;
  const Acceptance& acceptance_;
  TemporalSearch predicted_;  ///< kept between calls, as is the next
  GlobalSearch among_;
};

}  // namespace quadedge::motion
