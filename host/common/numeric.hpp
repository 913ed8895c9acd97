#pragma once
/// \file numeric.hpp  Constants and arithmetic that several folders need.

#include <cstdint>
#include <limits>

namespace quadedge {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegreesPerRadian = 57.295779513082320876798;

/// The least multiple of `unit` that is not below `value`.
constexpr int round_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

/// A share; NaN of nothing.
constexpr double ratio(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNan;
}

}  // namespace quadedge
