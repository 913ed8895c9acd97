#pragma once
/// \file bilinear.hpp  Bilinear interpolation.

#include <algorithm>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

/// Bilinear interpolation of value(column, row) at a position with grid points on all four sides.
template <class Value>
float bilinear_inside(double x, double y, const Value& value) {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const float above = (1 - fx) * value(x0, y0) + fx * value(x0 + 1, y0);
  const float below = (1 - fx) * value(x0, y0 + 1) + fx * value(x0 + 1, y0 + 1);
  return (1 - fy) * above + fy * below;
}

/// The same over a grid of width x height, whose border is replicated; NaN counts as 0.
template <class Value>
float bilinear(int width, int height, double x, double y, const Value& value) {
  x = std::max(0.0, std::min(x, width - 1.0));  // in this order, NaN becomes 0
  y = std::max(0.0, std::min(y, height - 1.0));
  const int x0 = std::min(static_cast<int>(x), std::max(width - 2, 0)),
            y0 = std::min(static_cast<int>(y), std::max(height - 2, 0));
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const float above = (1 - fx) * value(x0, y0) + fx * value(x1, y0);
  const float below = (1 - fx) * value(x0, y1) + fx * value(x1, y1);
  return (1 - fy) * above + fy * below;
}

/// Value of source_x or source_y of a table at a pixel of the pinhole camera.
inline float bilinear(const UndistortionTable& table, const std::vector<float>& values, double x, double y) {
  return bilinear(table.width, table.height, x, y, [&](int column, int row) {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(table.width) +
                  static_cast<std::size_t>(column)];
  });
}

}  // namespace quadedge
