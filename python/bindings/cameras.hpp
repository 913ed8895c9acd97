#pragma once
/// \file cameras.hpp  Rigs as arguments: from a Rig, a Dataset or a Synthetic.

#include <string>

#include "bindings.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::python {

/// From a Rig, a Dataset or a Synthetic. \throws TypeError for anything else.
StereoRig rig_of(nb::handle source);

/// A path, or two paths joined by a comma, as the library takes them; None becomes "". \throws TypeError.
std::string files_of(nb::handle files);

}  // namespace quadedge::python
