#pragma once
/// \file evaluate_matching.hpp  Evaluates every filter of the matching against ground truth of the edges.
/// Part of quadedge::quadedge.

#include <string>

#include "quadedge/config.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/device.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge {

/// Recall, precision and ambiguity after every filter (the paper's Tables 1 to 3), as the JSON document that `quadedge
/// evaluate matching --json` writes. `frames`: number of frames to evaluate from the start; 0: all. \throws DataError
/// for a recording without disparities or depths; UsageError for the reference device, which has no taps; DeviceError.
std::string evaluate_matching(const Dataset& dataset, Device& device, const Config& config, int frames = 0);
/// The same for a rendered scene.
std::string evaluate_matching(const SyntheticOptions& scene, Device& device, const Config& config, int frames = 0);

}  // namespace quadedge
