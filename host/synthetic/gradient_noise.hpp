#pragma once
/// \file gradient_noise.hpp  Smooth noise of one wavelength for textures.

#include <array>
#include <cmath>
#include <cstdint>

#include "synthetic/hash.hpp"

namespace quadedge::synthetic {

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

}  // namespace quadedge::synthetic
