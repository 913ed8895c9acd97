#pragma once
/// \file rectification_error.hpp  How far right points lie beside the epipolar lines of the calibration.

#include <cmath>

namespace quadedge {

/// Distance of a right point from its epipolar line as a linear function of the left pixel,
/// offset + slope_x u + slope_y v, where u and v range from -1/2 to 1/2 over the left image [px of the right image].
/// Positive towards (ey, -ex) for a line of direction (ex, ey): downwards on a rectified rig.
struct RectificationError {
  double offset = 0, slope_x = 0, slope_y = 0;

  /// Its largest absolute value over the image [px].
  double largest() const { return std::abs(offset) + 0.5 * (std::abs(slope_x) + std::abs(slope_y)); }
  RectificationError operator-(const RectificationError& other) const {
    return {offset - other.offset, slope_x - other.slope_x, slope_y - other.slope_y};
  }
  /// The linear function of (x, y, 1) for an image of this size [px].
  struct Plane {
    double x, y, one;
  };
  Plane plane(int width, int height) const {
    return {slope_x / width, slope_y / height, offset - 0.5 * (slope_x + slope_y)};
  }
};

}  // namespace quadedge
