#pragma once
/// \file poor_images.hpp  Images that are too bad to judge a calibration by: saturated, unequally exposed.

#include <string>

#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// Whether one image is so much brighter that corners are not found again where it is saturated.
bool hides_corners(const CornerSearch& search);

/// Why corners leave their lines, if the images are to blame, in a sentence; else empty.
/// \param seen what was found, between the figure and the cause
std::string poor_images(const CornerSearch& search, const std::string& seen);

}  // namespace quadedge::rig
