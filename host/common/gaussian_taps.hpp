#pragma once
/// \file gaussian_taps.hpp  Sampled Gaussian derivatives, used by the reference and for the tables of the device
/// kernels.

#include <array>
#include <cmath>

#include "quadedge/pi.hpp"

namespace quadedge {

/// The Gaussian and its first four derivatives at offset `u` [px] for scale `sigma` [px]; analytic, not renormalised.
/// Element n is the derivative of order n. The derivative of an image at x is the sum over pixels k of I(k) G^(n)(x -
/// k).
inline std::array<double, 5> gaussian_derivatives(double u, double sigma) {
  const double s2 = sigma * sigma;
  const double g = std::exp(-u * u / (2.0 * s2)) / (std::sqrt(2.0 * kPi) * sigma);
  const double u2 = u * u;
  return {g, -u / s2 * g, (u2 - s2) / (s2 * s2) * g, u * (3.0 * s2 - u2) / (s2 * s2 * s2) * g,
          (u2 * u2 - 6.0 * u2 * s2 + 3.0 * s2 * s2) / (s2 * s2 * s2 * s2) * g};
}

/// Radius R of a filter [px], at least 4 sigma. Filters centred on a pixel have 2 R + 1 taps; they are symmetric, so
/// that a constant image has zero gradient.
inline int kernel_radius(double sigma) { return static_cast<int>(std::ceil(4.0 * sigma)); }

}  // namespace quadedge
