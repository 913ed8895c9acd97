#pragma once
/// \file lenses.hpp  The lenses of the renderer.

#include <string>

#include "quadedge/camera.hpp"

namespace quadedge::synthetic {

/// One of synthetic_lenses(), with parameters typical of calibrations of real cameras. `focal`: focal length of the
/// corresponding pinhole camera [px]. Wide-angle lenses have a larger field of view than that camera.
Lens make_lens(const std::string& name, double focal);

}  // namespace quadedge::synthetic
