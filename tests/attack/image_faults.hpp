#pragma once
/// \file image_faults.hpp  Faults of images, while the rig is as calibrated.

#include "attack_sequence.hpp"

namespace attack {

/// The grey level of a pixel of the changed image, before it is clipped.
using PixelChange = std::function<double(const quadedge::Image& image, int x, int y, bool is_left, std::size_t frame)>;
Alteration every_pixel(const PixelChange& change);
/// Multiplies the grey levels of the left and of the right images and clips them, as longer exposures do.
Alteration brighter(double left, double right);
/// Divides the grey levels of every second frame, whose noise stays: exposures in turn.
Alteration exposures_in_turn(double ratio);
/// Compresses all images as JPEG does.
Alteration compressed(int quality);
/// Drops on both lenses, each its own: darker, blurred and mirrored views.
Alteration drops(int count);
/// A lamp at the camera, which lights the middle of the view and leaves its border in the dark.
Alteration lamp();
/// A wall with two equal posters, `distance` px apart, which the camera passes sideways by `speed` px per frame.
void show_posters(Sequence& sequence, double distance, double speed);

}  // namespace attack
