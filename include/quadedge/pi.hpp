#pragma once
/// \file pi.hpp  The numbers that C++17 has no name for.

namespace quadedge {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  ///< rad

}  // namespace quadedge
