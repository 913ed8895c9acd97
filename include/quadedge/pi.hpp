#pragma once
/// \file pi.hpp  Mathematical constants that C++17 lacks.

namespace quadedge {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  ///< rad

}  // namespace quadedge
