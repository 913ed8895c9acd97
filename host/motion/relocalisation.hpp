#pragma once
/// \file relocalisation.hpp  Hypothesis: the camera may have moved arbitrarily; edges are matched globally.

#include "motion/motion_hypothesis.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// Matches a subset of the edges over the whole left image by wide descriptors.
class Relocalisation : public MotionHypothesis {
 public:
  Relocalisation(frontend::Frontend& frontend, StepBuilder& steps, const Config& config);
  StepHandle propose(const MotionQuery& query, const Evidence& evidence) override;
  bool matches_globally() const override { return true; }
  Effort effort() const override { return Effort::everything; }

 private:
  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  PoseConfig limits_;
  int wide_edges_;
};

/// Limits for the motion of global matches, whose inlier distance is larger because a match may be a neighbour of the
/// correct edge.
PoseConfig limits_of_global_matches(const Config& config);

}  // namespace quadedge::motion
