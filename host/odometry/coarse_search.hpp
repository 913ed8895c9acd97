#pragma once
/// \file coarse_search.hpp  Hypothesis: a part of the edges lies within a circle around where they are predicted.

#include "odometry/motion_hypothesis.hpp"
#include "odometry/step_builder.hpp"

namespace quadedge::odometry {

/// Matches every so many edges with temporal.coarse_*'s strict limits.
class CoarseSearch : public MotionHypothesis {
 public:
  /// Near the prediction of constant velocity, where there is one.
  static CoarseSearch near_prediction(frontend::Frontend& frontend, StepBuilder& steps, const Config& config);
  /// In wide circles, around where the edges were where there is no prediction.
  static CoarseSearch wide(frontend::Frontend& frontend, StepBuilder& steps, const Config& config, int image_width);

  StepHandle propose(const MotionQuery& query, Evidence& evidence) override;
  bool trusts_prediction() const override { return trusts_prediction_; }

 private:
  CoarseSearch(frontend::Frontend& frontend, StepBuilder& steps, const Config& config, double radius,
               bool trusts_prediction);

  frontend::Frontend& frontend_;
  StepBuilder& steps_;
  PoseConfig limits_;
  int edges_;      ///< looked for at least
  double radius_;  ///< px
  bool trusts_prediction_;
  TemporalSearch search_;  ///< kept for its memory
};

}  // namespace quadedge::odometry
