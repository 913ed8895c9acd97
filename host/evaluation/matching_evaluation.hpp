#pragma once
/// \file matching_evaluation.hpp  Runs the production pipeline over a pair or a sequence and evaluates every filter.

#include <functional>

#include "evaluation/matching_result.hpp"
#include "evaluation/matching_source.hpp"
#include "quadedge/device.hpp"

namespace quadedge::evaluation {

/// Options of evaluate_matching().
struct MatchingOptions {
  int frames = 0;  ///< number of frames to use from each source; 0: all
  MatchingTolerance tolerance;
  bool distributions = false;  ///< whether to collect distributions of the cues
  int draw_frame = -1;         ///< frame to keep for drawing (the last one if there are fewer frames); -1: none
  std::function<void(int done, int total)> progress;
};

/// Tracks the frames of a source with a tap on the pipeline. If the configuration does not limit the disparity, the
/// source's limit applies. \throws UsageError for the reference device, whose stages have no taps; DataError;
/// DeviceError
MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config,
                                 const MatchingOptions& options = {});

}  // namespace quadedge::evaluation
