#pragma once
/// \file cladding.hpp  Repetitive reflectance: courses of bricks, boards or tiles with joints.

#include <cstdint>
#include <memory>

#include "synthetic/texture.hpp"

namespace quadedge::synthetic {

/// Appearance of a clad surface. Units are arranged along u in courses, which follow one another along v.
struct CladdingStyle {
  double unit_width = 0.0, unit_height = 0.0;  ///< from joint to joint [m]
  double joint = 0.0;                          ///< width of a joint [m]
  double bond = 0.0;                           ///< shift of every second course [unit widths]
  double mean = 130.0, spread = 10.0;          ///< units are mean +- spread [grey levels]
  double bevel = 0.0;                          ///< excess brightness of their left side over their middle [grey levels]
  double joint_grey = 90.0;                    ///< [grey levels]
  double noise = 5.0, noise_size = 0.1;        ///< amplitude [grey levels] and largest wavelength [m] of the noise
  double grain = 1.0;                          ///< ratio of length (along v) to width of the noise grains
};

/// Every texel is the mean over a square 1.5 texels wide (exact for the courses; noise fades at the sampling limit),
/// which prevents aliasing at any texel size.
std::unique_ptr<const Painter> cladding(const CladdingStyle& style, std::uint64_t seed);

}  // namespace quadedge::synthetic
