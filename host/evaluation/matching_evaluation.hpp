#pragma once
/// \file matching_evaluation.hpp  Runs the production pipeline over a pair or a sequence and judges every filter.

#include <functional>

#include "evaluation/matching_result.hpp"
#include "evaluation/matching_source.hpp"
#include "quadedge/device.hpp"

namespace quadedge::evaluation {

/// What to evaluate, and how far.
struct MatchingOptions {
  int frames = 0;  ///< only the first of each source; 0: all
  MatchingTolerance tolerance;
  bool distributions = false;  ///< of the cues
  int draw_frame = -1;         ///< keep this frame (or the last one, where there are not as many) for drawing; -1: none
  std::function<void(int done, int total)> progress;
};

/// Tracks a source's frames with a tap on the pipeline. Where neither configuration entry limits the disparity, the
/// source's own limit holds. \throws UsageError for the reference device, whose stages have no taps; DataError,
/// DeviceError.
MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config,
                                 const MatchingOptions& options = {});

}  // namespace quadedge::evaluation
