#pragma once
/// \file camera_options.hpp  What users say of their cameras: calibration, field of view, mask.

#include "cli/command.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::cli {

/// Declares --calibration, --fov and --mask.
void declare_cameras(Options& options, DatasetOptions& dataset);

}  // namespace quadedge::cli
