#pragma once
/// \file angles.hpp  Differences of directions.

#include <cmath>

#include "quadedge/pi.hpp"

namespace quadedge {

/// Smallest difference of two directions modulo a full turn [rad]; both in (-pi, pi].
inline float angle_between(float a, float b) {
  constexpr auto kHalfTurn = static_cast<float>(kPi);
  const float d = std::fabs(a - b);
  return d > kHalfTurn ? 2.0f * kHalfTurn - d : d;
}

}  // namespace quadedge
