#pragma once
/// \file angles.hpp  Degrees of the configuration to the radians of the code, and differences of directions.

#include <cmath>

namespace quadedge {

constexpr double radians(double degrees) { return degrees * (3.14159265358979323846 / 180.0); }

/// Smallest difference of two directions modulo a full turn [rad], both in (-pi, pi].
inline float angle_between(float a, float b) {
  constexpr float kPi = 3.14159265358979f;
  const float d = std::fabs(a - b);
  return d > kPi ? 2.0f * kPi - d : d;
}

/// Smallest difference of two directions modulo a half turn [rad].
inline float line_angle_between(float a, float b) {
  constexpr float kPi = 3.14159265358979f;
  const float d = angle_between(a, b);
  return d > 0.5f * kPi ? kPi - d : d;
}

}  // namespace quadedge
