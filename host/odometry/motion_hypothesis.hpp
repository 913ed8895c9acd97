#pragma once
/// \file motion_hypothesis.hpp  A way to come to a motion that is worth confirming. The list stands in
/// motion_search.cpp.

#include "odometry/motion_step.hpp"

namespace quadedge::odometry {

/// What the hypotheses before this one have found of the same frame.
struct Evidence {
  const MotionStep* global_matches = nullptr;  ///< edges found anywhere in the image; null unless looked for
  const MotionStep* confirmed = nullptr;       ///< the first motion that all edges confirm; null unless there is one
};

/// Looks for a motion since the query's base with a part of the edges.
class MotionHypothesis {
 public:
  virtual ~MotionHypothesis() = default;

  /// A step whose motion is worth confirming where its status is ok; null where there is nothing to try.
  virtual StepHandle propose(const MotionQuery& query, Evidence& evidence) = 0;

  /// Whether it only looks near the prediction: what it finds may end the search, and else gives way to an equal motion
  /// that was found without it.
  virtual bool trusts_prediction() const { return false; }

  /// Whether it competes with a motion a pixel or two apart: then a fit with the usual inlier distance would take in
  /// the edges of both, and end between them.
  virtual bool asks_for_close_agreement() const { return false; }
  /// Takes as long as all the rest of a frame: asked only where cheaper ones leave a doubt.
  virtual bool is_costly() const { return false; }
};

}  // namespace quadedge::odometry
