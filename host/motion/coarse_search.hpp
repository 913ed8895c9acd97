#pragma once
/// \file coarse_search.hpp  Hypothesis: a subset of the edges lies within a radius of the predicted positions.

#include "motion/motion_hypothesis.hpp"
#include "motion/step_builder.hpp"

namespace quadedge::motion {

/// Matches every n-th edge with the strict limits of temporal.coarse_*.
class CoarseSearch : public MotionHypothesis {
 public:
  /// Around the constant-velocity prediction, if there is one.
  static CoarseSearch near_prediction(frontend::Frontend& frontend, StepBuilder& steps, const Config& config);
  /// With a large radius, around the previous positions if there is no prediction.
  static CoarseSearch wide(frontend::Frontend& frontend, StepBuilder& steps, const Config& config, int image_width);

  StepHandle propose(const MotionQuery& query, const Evidence& evidence) override;
  Effort effort() const override { return trusts_prediction_ ? Effort::prediction : Effort::inexpensive; }

 private:
  CoarseSearch(frontend::Frontend& frontend, StepBuilder& steps, const Config& config, double radius,
               bool trusts_prediction);

  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  PoseConfig limits_;
  int edges_;      ///< minimum number of edges to match, if there are as many
  double radius_;  ///< px
  bool trusts_prediction_;
  TemporalSearch search_;  ///< kept between calls
};

}  // namespace quadedge::motion
