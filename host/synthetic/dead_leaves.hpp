#pragma once
/// \file dead_leaves.hpp  Reflectance that never repeats.

#include <cstdint>
#include <memory>

#include "synthetic/texture.hpp"

namespace quadedge::synthetic {

/// What a surface looks like.
struct TextureStyle {
  double feature = 0.0;      ///< size of the largest leaves [m]; 0: no leaves, noise alone
  int levels = 4;            ///< generations of leaves, each half as large as the one before
  double cover = 0.4;        ///< leaves per cell of their size in the generations after the first, 0 to 1
  double alignment = 0.0;    ///< fraction of the leaves that are upright rectangles, 0 to 1
  double noise = 10.0;       ///< amplitude of the fractal noise [grey levels]
  double noise_size = 0.25;  ///< largest noise wavelength [m]
  double mean = 130.0;       ///< grey level of the ground
  double spread = 70.0;      ///< leaves are mean +- spread [grey levels], kept in 25..235
};

/// Opaque leaves of all sizes lying on one another ("dead leaves": sharp reflectance steps, corners and occlusions at
/// several scales) plus multi-octave gradient noise. Steps are ramps 1.5 texels wide and noise or leaves below the
/// sampling limit are faded, so that a texel of half a pixel does not alias.
std::unique_ptr<const Painter> dead_leaves(const TextureStyle& style, std::uint64_t seed);

/// Adds four octaves of gradient noise, `wavelength` [m] and shorter, and keeps the result in 25..235 grey levels.
/// `stretch`: how much longer than wide its grains are, along v.
void add_noise(const TexelSquare& square, double amplitude, double wavelength, std::uint64_t seed,
               double stretch = 1.0);

}  // namespace quadedge::synthetic
