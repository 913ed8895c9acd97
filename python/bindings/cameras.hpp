#pragma once
/// \file cameras.hpp  Rigs as arguments: from a Rig, a Dataset or a Synthetic.

#include <string>

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::python {

/// A rig and the range of its disparities.
struct Cameras {
  StereoRig rig;
  double max_disparity = 0;  ///< px
};

/// From a Rig, a Dataset or a Synthetic. \throws TypeError for anything else.
Cameras cameras_of(nb::handle source);

/// Sets the maximum disparity where the configuration leaves it open.
void complete(Config& config, const Cameras& cameras);

/// A path, or two paths joined by a comma, as the library takes them; None becomes "". \throws TypeError.
std::string files_of(nb::handle files);

}  // namespace quadedge::python
