#pragma once
/// \file lenses.hpp  The lenses of the renderer.

#include <string>

#include "quadedge/lens.hpp"

namespace quadedge::synthetic {

/// One of synthetic_lenses(): its model, parameters as calibrations of real cameras have them, and focal lengths made
/// of those of the pinhole camera that it stands for [px]. Wide lenses see more than that camera.
Lens make_lens(const std::string& name, double focal);

}  // namespace quadedge::synthetic
