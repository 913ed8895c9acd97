#include "odometry/pinhole_view.hpp"

#include <algorithm>

namespace quadedge::odometry {
namespace {

/// Bilinear interpolation of value(x, y) over a grid of width x height.
template <class Value>
float interpolate(int width, int height, double x, double y, const Value& value) {
  x = std::clamp(x, 0.0, width - 1.0);
  y = std::clamp(y, 0.0, height - 1.0);
  const int x0 = std::min(static_cast<int>(x), std::max(width - 2, 0)),
            y0 = std::min(static_cast<int>(y), std::max(height - 2, 0));
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const float above = (1 - fx) * value(x0, y0) + fx * value(x1, y0);
  const float below = (1 - fx) * value(x0, y1) + fx * value(x1, y1);
  return (1 - fy) * above + fy * below;
}

}  // namespace

float PinholeView::at(double x, double y) const {
  const auto grey = [&](int column, int row) { return recorded_.at(column, row); };
  if (table_.empty()) return interpolate(recorded_.width, recorded_.height, x, y, grey);
  const auto source = [&](const std::vector<float>& values) {
    return interpolate(table_.width, table_.height, x, y, [&](int column, int row) {
      return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(table_.width) +
                    static_cast<std::size_t>(column)];
    });
  };
  return interpolate(recorded_.width, recorded_.height, static_cast<double>(source(table_.source_x)),
                     static_cast<double>(source(table_.source_y)), grey);
}

}  // namespace quadedge::odometry
