#pragma once
/// \file second_motion.hpp  Hypothesis: the first motion of the global matches is that of an object, and the scene has
/// another one.

#include <cstdint>
#include <vector>

#include "motion/motion_hypothesis.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// Searches among the global matches that the motion of Relocalisation does not explain.
class SecondMotion : public MotionHypothesis {
 public:
  SecondMotion(StepBuilder& steps, const Config& config);
  StepHandle propose(const MotionQuery& query, const Evidence& evidence) override;
  Effort effort() const override { return Effort::everything; }

 private:
  StepBuilder& steps_;
  PoseConfig limits_;
  std::vector<std::uint8_t> explained_;  ///< kept between calls
};

}  // namespace quadedge::motion
