#pragma once
/// \file wide_description.hpp  Plain C++ twin of kernels/wide_description.cl.

#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

inline constexpr int kWideHalf = 7;            ///< samples on either side of the middle one
inline constexpr double kWideCellWidth = 3.0;  ///< small pixels: 9 px of the image
inline constexpr double kWideClip = 0.2;       ///< largest fraction of the norm in one bin
inline constexpr double kWideNorm = 512.0;

/// Means of blocks of kWideShrink x kWideShrink pixels; remaining pixels at the right and at the bottom are ignored.
struct SmallImage {
  int width = 0, height = 0;
  std::vector<float> pixels;
};
SmallImage shrink(const ImageView& image);

/// The surroundings of the left edge of every step-th stereo edge, kWideBytes each: gradients of the small image on a
/// grid of 15 x 15 samples (3 px apart, bilinear, border replicated) centred on the edge and turned with it, in 4 x 4
/// cells of 9 px, clipped and normalised as SIFT is (Lowe 2004, section 6). A gradient counts in each of eight
/// directions with its length times the cube of the positive part of its cosine with it, so that the descriptor changes
/// smoothly with rotation. Bytes [cell across][cell along][angle]; all zeros where the image is flat.
std::vector<std::uint8_t> wide_descriptions(const SmallImage& small, const StereoEdges& edges, int step);

}  // namespace quadedge::reference
