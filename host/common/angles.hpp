#pragma once
/// \file angles.hpp  Differences of directions.

#include <cmath>

namespace quadedge {

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
