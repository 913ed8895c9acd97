#pragma once
/// \file relocalisation.hpp  Hypothesis: the camera moved anyhow, and edges are found anywhere in the image.

#include "odometry/motion_hypothesis.hpp"
#include "odometry/step_builder.hpp"

namespace quadedge::odometry {

/// Matches a part of the edges by what surrounds them, wherever they lie in the left image.
class Relocalisation : public MotionHypothesis {
 public:
  Relocalisation(frontend::Frontend& frontend, StepBuilder& steps, const Config& config);
  StepHandle propose(const MotionQuery& query, Evidence& evidence) override;
  bool is_costly() const override { return true; }

 private:
  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  PoseConfig limits_;
};

/// Limits for the motion of edges found anywhere: a found edge may be a neighbour of the right one.
PoseConfig limits_of_global_matches(const Config& config);

}  // namespace quadedge::odometry
