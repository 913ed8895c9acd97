#pragma once
/// \file reflectance.hpp  Reflectance of surfaces: dead leaves, which do not repeat, and courses of bricks, boards
/// or tiles, which do.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "scenes/hash.hpp"
#include "scenes/texture.hpp"

namespace quadedge::synthetic {

// Smooth noise of one wavelength for textures.

/// Gradient noise of unit wavelength, about -1..1. Caches the lattice cell, which neighbouring calls share.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t key) : key_(key) {}

  double operator()(double x, double y) {
    const double fx = std::floor(x), fy = std::floor(y);
    if (fx != cell_x_ || fy != cell_y_) enter(fx, fy);
    const double tx = x - fx, ty = y - fy, u = fade(tx), v = fade(ty);
    const auto corner = [&](std::size_t i, double dx, double dy) { return gx_[i] * dx + gy_[i] * dy; };
    const double top = corner(0, tx, ty) * (1.0 - u) + corner(1, tx - 1.0, ty) * u;
    const double bottom = corner(2, tx, ty - 1.0) * (1.0 - u) + corner(3, tx - 1.0, ty - 1.0) * u;
    return 1.6 * (top * (1.0 - v) + bottom * v);
  }

 private:
  static double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

  void enter(double fx, double fy) {
    cell_x_ = fx;
    cell_y_ = fy;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint64_t bits =
          combine(combine(key_, static_cast<std::int64_t>(fx) + static_cast<std::int64_t>(i % 2)),
                  static_cast<std::int64_t>(fy) + static_cast<std::int64_t>(i / 2));
      gx_[i] = static_cast<double>(static_cast<std::int32_t>(bits)) * 0x1p-31;
      gy_[i] = static_cast<double>(static_cast<std::int32_t>(bits >> 32)) * 0x1p-31;
    }
  }

  std::uint64_t key_;
  double cell_x_ = 0.5, cell_y_ = 0.5;  // no cell yet
  std::array<double, 4> gx_{}, gy_{};
};

// Non-repetitive reflectance.

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

// Repetitive reflectance: courses of bricks, boards or tiles with joints.

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
