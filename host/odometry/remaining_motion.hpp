#pragma once
/// \file remaining_motion.hpp  Hypothesis: the motion found is that of a thing, and the scene moves a few pixels
/// otherwise.

#include "odometry/motion_hypothesis.hpp"
#include "odometry/step_builder.hpp"

namespace quadedge::odometry {

/// Looks among the quads of a confirmed motion for those that do not agree with it closely. Two motions a pixel or two
/// apart both lie within the inlier distance of a compromise between them; what neither explains exactly tells.
class RemainingMotion : public MotionHypothesis {
 public:
  RemainingMotion(StepBuilder& steps, const Config& config);
  StepHandle propose(const MotionQuery& query, Evidence& evidence) override;
  bool asks_for_close_agreement() const override { return true; }

 private:
  StepBuilder& steps_;
  PoseConfig limits_;
  double orientation_;                ///< rad
  std::vector<std::uint8_t> agrees_;  ///< kept for its memory
};

}  // namespace quadedge::odometry
