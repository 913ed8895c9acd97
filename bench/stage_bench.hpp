#pragma once
/// \file stage_bench.hpp  Kernel time of one stage by OpenCL events, for each of its variants.

#include <functional>
#include <string>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace stage_bench {

/// The device to measure: QUADEDGE_DEVICE, "auto" without it.
std::string device_choice();

/// What makes the built-in sequence run a stage that it would pass over.
using Prepare = std::function<void(quadedge::Config&, quadedge::StereoRig&)>;

/// Registers STAGE/VARIANT for every variant in the table, or STAGE alone where it has none. Each repetition takes the
/// second frame of the built-in sequence and matches it with the first one, guided and anywhere; only the stage's
/// kernels count. \returns true, so that a file can register while the program starts.
bool register_stage(const std::string& stage, const Prepare& prepare = {});

/// Lists in place of the fused kernel, which leaves out the stages that work on lists.
void match_by_lists(quadedge::Config& config, quadedge::StereoRig& rig);
/// SIFT takes part in the stereo cascade, with the paper's limit.
void match_with_sift(quadedge::Config& config, quadedge::StereoRig& rig);

}  // namespace stage_bench
