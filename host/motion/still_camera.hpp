#pragma once
/// \file still_camera.hpp  Hypothesis: the camera is stationary, and only objects in front of it move.

#include "motion/motion_hypothesis.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// Proposes that the camera has not moved since the base.
class StillCamera : public MotionHypothesis {
 public:
  explicit StillCamera(StepBuilder& steps) : steps_(steps) {}
  StepHandle propose(const MotionQuery& query, const Evidence&) override {
    StepHandle step = steps_.take(query.base);
    step->motion = {};
    step->motion.status = pose::MotionStatus::ok;
    return step;
  }
  Effort effort() const override { return Effort::inexpensive; }
  bool requires_close_agreement() const override { return true; }

 private:
  StepBuilder& steps_;
};

}  // namespace quadedge::motion
