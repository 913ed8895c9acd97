#pragma once
/// \file cladding.hpp  Reflectance that repeats: courses of bricks, boards or tiles with joints between them.

#include <cstdint>
#include <memory>

#include "synthetic/texture.hpp"

namespace quadedge::synthetic {

/// What a clad surface looks like. Units lie in courses, along u, that follow one another along v.
struct CladdingStyle {
  double unit_width = 0.0, unit_height = 0.0;  ///< from joint to joint [m]
  double joint = 0.0;                          ///< width of a joint [m]
  double bond = 0.0;                           ///< how far every second course is shifted [unit widths]
  double mean = 130.0, spread = 10.0;          ///< units are mean +- spread [grey levels]
  double bevel = 0.0;                    ///< their left side is that much brighter than their middle [grey levels]
  double joint_grey = 90.0;              ///< [grey levels]
  double noise = 5.0, noise_size = 0.1;  ///< amplitude [grey levels] and largest wavelength [m] of the noise
  double grain = 1.0;                    ///< how much longer than wide the noise is, along v
};

/// Every texel is the mean over a square 1.5 texels wide (exact for the courses; the noise fades at the sampling
/// limit), so that no texel size aliases.
std::unique_ptr<const Painter> cladding(const CladdingStyle& style, std::uint64_t seed);

}  // namespace quadedge::synthetic
