#pragma once
/// \file rig_observation.hpp  Collects what the frames of a run show of its rig.

#include "output/rig_maps.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::cli {

/// Adds the frame tracked last. If the rows have changed, what earlier frames showed is that of another rig, and is
/// dropped.
void observe_rig(const StereoOdometry& odometry, const FrameResult& result, report::RigMaps& maps);

}  // namespace quadedge::cli
