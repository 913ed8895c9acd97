#pragma once
/// \file poor_images.hpp  Images that are too bad to judge a calibration by: saturated, compressed, unequally exposed.

#include <optional>

#include "quadedge/image.hpp"
#include "rig/corner_matching.hpp"
#include "rig/rig_finding.hpp"

namespace quadedge::rig {

/// Mean difference between pixels on both sides of the borders of blocks of 8 x 8 px over that between other neighbours
/// in a recorded image: near 1, more in JPEG images of low quality.
double blockiness(const ImageView& image);

/// Whether one image is much brighter than the other.
bool is_uneven(const CornerSearch& search);
/// Whether one is so much brighter that corners are not found again where it is saturated.
bool hides_corners(const CornerSearch& search);

/// Why corners leave their lines, if the images are to blame: one of saturated_images, compressed_images and
/// uneven_images, with its figure. \param search what was found in the frame
std::optional<RigFinding> find_poor_images(const CornerSearch& search, const StereoFrame& frame);

}  // namespace quadedge::rig
