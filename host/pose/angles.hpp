#pragma once
/// \file angles.hpp  Degrees of the configuration to the radians of the code.

namespace quadedge::pose {

constexpr double radians(double degrees) { return degrees * (3.14159265358979323846 / 180.0); }

}  // namespace quadedge::pose
