#pragma once
/// \file interlacing.hpp  Images whose odd and even rows show different times, as interlaced video has them.

#include "quadedge/image.hpp"

namespace quadedge::rig {

/// Fraction of the textured cells of an image in which odd rows are shifted against even ones. Above
/// kInterlacedRatio the image is interlaced and moving. Reads every pixel once.
double combed_ratio(const ImageView& image);

}  // namespace quadedge::rig
