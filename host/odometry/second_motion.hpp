#pragma once
/// \file second_motion.hpp  Hypothesis: what was found anywhere first is the motion of a thing, and the scene has
/// another one.

#include <cstdint>
#include <vector>

#include "odometry/motion_hypothesis.hpp"
#include "odometry/step_builder.hpp"

namespace quadedge::odometry {

/// Looks among the edges found anywhere that the motion of Relocalisation does not explain.
class SecondMotion : public MotionHypothesis {
 public:
  SecondMotion(StepBuilder& steps, const Config& config);
  StepHandle propose(const MotionQuery& query, Evidence& evidence) override;
  bool is_costly() const override { return true; }

 private:
  StepBuilder& steps_;
  PoseConfig limits_;
  std::vector<std::uint8_t> explained_;  ///< kept for its memory
};

}  // namespace quadedge::odometry
