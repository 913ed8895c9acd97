#pragma once
/// \file numeric.hpp  Constants and arithmetic that several folders need.

#include <cstdint>
#include <limits>

namespace quadedge {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegreesPerRadian = 57.295779513082320876798;

/// Smallest multiple of `unit` that is not less than `value`.
constexpr int round_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

/// part / whole; NaN if `whole` is 0.
constexpr double ratio(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNan;
}

}  // namespace quadedge
