#pragma once
/// \file numeric.hpp  Constants and arithmetic that several folders need.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegreesPerRadian = 57.295779513082320876798;

/// Smallest multiple of `unit` that is not less than `value`.
constexpr int round_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

/// part / whole; NaN if `whole` is 0.
constexpr double ratio(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNan;
}

/// Smallest difference of two directions modulo a full turn [rad]; both in (-pi, pi].
inline float angle_between(float a, float b) {
  constexpr auto kHalfTurn = static_cast<float>(kPi);
  const float d = std::fabs(a - b);
  return d > kHalfTurn ? 2.0f * kHalfTurn - d : d;
}

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

/// The median of at least one value; the list is reordered. Of the two middle values of an even count it is the greater
/// one, which is one of the values; figures of reports take the mean of both (report::median()).
template <class T>
T upper_median(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace quadedge
