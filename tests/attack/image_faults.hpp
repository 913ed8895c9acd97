#pragma once
/// \file image_faults.hpp  Faults of images, while the rig is as calibrated; and calibrations that are wrong in both
/// cameras alike.

#include "attack_sequence.hpp"

namespace attack {

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
/// Both focal lengths of the calibration are wrong.
Alteration focal_lengths(double factor);
/// Both images lose a part of their width and height on all sides; the calibration is that of whole images.
Alteration cropped(double part);
/// A wall with two equal posters, `distance` px apart, which the camera passes sideways by `speed` px per frame.
void show_posters(Sequence& sequence, double distance, double speed);

}  // namespace attack
