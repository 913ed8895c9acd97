#pragma once
/// \file evaluate_matching.hpp  What every filter of the matching keeps and loses, judged by ground truth of the edges.
/// Part of quadedge::quadedge.

#include <string>

#include "quadedge/config.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/device.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge {

/// Recall, precision and ambiguity after every filter (the paper's Tables 1 to 3), as the JSON document that `quadedge
/// evaluate matching --json` writes. `frames`: only the first ones; 0: all. \throws DataError for a recording without
/// disparities or depths, UsageError for the reference device, whose stages cannot be watched, DeviceError.
std::string evaluate_matching(const Dataset& dataset, Device& device, const Config& config, int frames = 0);
/// The same of a rendered scene.
std::string evaluate_matching(const SyntheticOptions& scene, Device& device, const Config& config, int frames = 0);

}  // namespace quadedge
