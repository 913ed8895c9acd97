#pragma once
/// \file matching_evaluation.hpp  Runs the production pipeline over a pair or a sequence and judges every filter.

#include <functional>

#include "evaluation/matching_result.hpp"
#include "evaluation/matching_source.hpp"
#include "quadedge/device.hpp"

namespace quadedge::evaluation {

/// Tracks the first `frames` frames (0: all) with a tap on the pipeline. Where neither configuration entry limits the disparity,
/// the source's own limit holds. `progress(done, total)` may be empty.
/// \throws UsageError for the reference device, whose stages have no taps; DataError, DeviceError.
MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config, int frames = 0,
                                 const MatchingTolerance& tolerance = {}, const std::function<void(int, int)>& progress = {});

}  // namespace quadedge::evaluation
