#pragma once
/// \file motion_hypothesis.hpp  Interface of the sources of motion hypotheses. motion_search.cpp lists them.

#include "motion/motion_step.hpp"

namespace quadedge::motion {

/// What the preceding hypotheses have shown for the same frame.
struct Evidence {
  const MotionStep* global_matches = nullptr;  ///< step with global matches; null if none were computed
  const MotionStep* confirmed = nullptr;       ///< first motion confirmed with all edges; null if there is none
};

/// Proposes a motion since the query's base from a subset of the edges.
class MotionHypothesis {
 public:
  virtual ~MotionHypothesis() = default;

  /// Returns a step whose motion has to be confirmed if its status is ok, or null if there is nothing to try.
  virtual StepHandle propose(const MotionQuery& query, const Evidence& evidence) = 0;

  /// The level of effort from which it is tried. A hypothesis of Effort::prediction searches near the prediction only.
  virtual Effort effort() const = 0;

  /// Whether its matches are Evidence::global_matches for the hypotheses that follow.
  virtual bool matches_globally() const { return false; }

  /// Whether it competes with a motion that differs by a pixel or two. With the usual inlier distance, a fit would
  /// include the edges of both motions and end between them.
  virtual bool requires_close_agreement() const { return false; }
};

}  // namespace quadedge::motion
