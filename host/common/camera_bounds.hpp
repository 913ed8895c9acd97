#pragma once
/// \file camera_bounds.hpp  Bounds of the numbers that a camera can have, whoever states them.

#include <optional>
#include <string>

#include "quadedge/camera.hpp"

namespace quadedge {

/// A number out of bounds.
struct CameraComplaint {
  std::string found, expected;
};

/// The first number of the camera that no camera has: focal lengths outside 0.01 to 100 image sizes (180 to 0.6
/// degrees), one ten times the other, a principal point ten image sizes away. A width or height of 0 is unknown; the
/// largest possible image then stands for its size.
std::optional<CameraComplaint> complaint_about(const PinholeCamera& camera);

/// Largest absolute value of a distortion coefficient; rational models reach some hundreds.
constexpr double kLargestCoefficient = 1e5;

}  // namespace quadedge
