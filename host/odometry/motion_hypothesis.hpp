#pragma once
/// \file motion_hypothesis.hpp  Interface of the sources of motion hypotheses. motion_search.cpp lists them.

#include "odometry/motion_step.hpp"

namespace quadedge::odometry {

/// Results of the preceding hypotheses for the same frame.
struct Evidence {
  const MotionStep* global_matches = nullptr;  ///< step with global matches; null if none were computed
  const MotionStep* confirmed = nullptr;       ///< first motion confirmed with all edges; null if there is none
};

/// Proposes a motion since the query's base from a subset of the edges.
class MotionHypothesis {
 public:
  virtual ~MotionHypothesis() = default;

  /// Returns a step whose motion has to be confirmed if its status is ok, or null if there is nothing to try.
  virtual StepHandle propose(const MotionQuery& query, Evidence& evidence) = 0;

  /// Whether it searches near the prediction only. Its motion may end the search; otherwise, an equal motion found
  /// without the prediction takes precedence.
  virtual bool trusts_prediction() const { return false; }

  /// Whether it competes with a motion that differs by a pixel or two. With the usual inlier distance, a fit would
  /// include the edges of both motions and end between them.
  virtual bool requires_close_agreement() const { return false; }
  /// Whether it takes as long as the rest of a frame. Such hypotheses are tried only if the others leave doubt.
  virtual bool is_costly() const { return false; }
};

}  // namespace quadedge::odometry
