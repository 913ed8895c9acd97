#pragma once
/// \file stage_bench.hpp  Kernel time of one stage by OpenCL events, for each of its variants.

#include <functional>
#include <string>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace stage_bench {

/// The device to measure: QUADEDGE_DEVICE, or "auto" if unset.
std::string device_choice();

/// Changes a configuration or rig so that the built-in sequence runs a stage that it would skip.
using Prepare = std::function<void(quadedge::Config&, quadedge::StereoRig&)>;

/// Registers STAGE/VARIANT for every variant in the table, or STAGE if it has none. Each repetition processes the
/// second frame of the built-in sequence and matches it with the first one, guided and globally; only the kernels of
/// the stage count. \returns true, so that a file can register during static initialisation.
bool register_stage(const std::string& stage, const Prepare& prepare = {});

/// Candidate lists instead of the fused kernel, which skips the stages that process lists.
void match_by_lists(quadedge::Config& config, quadedge::StereoRig& rig);
/// Enables SIFT in the stereo cascade, with the limit of the paper.
void match_with_sift(quadedge::Config& config, quadedge::StereoRig& rig);

}  // namespace stage_bench
