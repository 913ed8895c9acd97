#pragma once
/// \file cameras.hpp  What of a data source the odometry wants to know.

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::python {

/// A rig, and how far the disparities of what it sees reach.
struct Cameras {
  StereoRig rig;
  double max_disparity = 0;  ///< px
};

/// Of a Rig, a Dataset or a Synthetic. \throws TypeError for anything else.
Cameras cameras_of(nb::handle source);

/// The largest disparity comes from the source where the configuration leaves it open.
void complete(Config& config, const Cameras& cameras);

}  // namespace quadedge::python
