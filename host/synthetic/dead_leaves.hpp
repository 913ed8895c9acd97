#pragma once
/// \file dead_leaves.hpp  Non-repetitive reflectance.

#include <cstdint>
#include <memory>

#include "synthetic/texture.hpp"

namespace quadedge::synthetic {

/// Appearance of a surface.
struct TextureStyle {
  double feature = 0.0;      ///< size of the largest leaves [m]; 0: noise without leaves
  int levels = 4;            ///< generations of leaves, each half the size of the previous one
  double cover = 0.4;        ///< leaves per cell of their size in the generations after the first, 0 to 1
  double alignment = 0.0;    ///< fraction of the leaves that are upright rectangles, 0 to 1
  double noise = 10.0;       ///< amplitude of the fractal noise [grey levels]
  double noise_size = 0.25;  ///< largest noise wavelength [m]
  double mean = 130.0;       ///< grey level of the background
  double spread = 70.0;      ///< leaves are mean +- spread [grey levels], limited to 25..235
};

/// Opaque leaves of all sizes on top of each other ("dead leaves": sharp reflectance steps, corners and occlusions at
/// several scales) plus multi-octave gradient noise. Steps are ramps 1.5 texels wide, and noise and leaves below the
/// sampling limit fade out, which prevents aliasing of texels of half a pixel.
std::unique_ptr<const Painter> dead_leaves(const TextureStyle& style, std::uint64_t seed);

/// Adds four octaves of gradient noise, of wavelength `wavelength` [m] and shorter, and limits the result to 25..235
/// grey levels. `stretch`: ratio of length (along v) to width of the noise grains.
void add_noise(const TexelSquare& square, double amplitude, double wavelength, std::uint64_t seed,
               double stretch = 1.0);

}  // namespace quadedge::synthetic
