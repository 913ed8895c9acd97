#pragma once
/// \file remaining_motion.hpp  Hypothesis: the motion found is that of an object, and the scene moves differently by a
/// few pixels.

#include "motion/motion_hypothesis.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// Searches among the quads of a confirmed motion for another motion of those that do not agree with it closely. Two
/// motions that differ by a pixel or two both lie within the inlier distance of a compromise between them; the quads
/// without close agreement separate them.
class RemainingMotion : public MotionHypothesis {
 public:
  RemainingMotion(StepBuilder& steps, const Config& config);
  StepHandle propose(const MotionQuery& query, const Evidence& evidence) override;
  Effort effort() const override { return Effort::inexpensive; }
  bool requires_close_agreement() const override { return true; }

 private:
  StepBuilder& steps_;
  PoseConfig limits_;
};

}  // namespace quadedge::motion
