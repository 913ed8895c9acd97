#include "odometry/equal_scale.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::odometry {
namespace {

constexpr double kMuchFiner = 1.5;

/// Value of a table at the corner or in the middle of its pixels, bilinear.
float sample(const UndistortionTable& table, const std::vector<float>& values, double x, double y) {
  const int i = std::clamp(static_cast<int>(x), 0, std::max(table.width - 2, 0)),
            j = std::clamp(static_cast<int>(y), 0, std::max(table.height - 2, 0));
  const auto a = static_cast<float>(x - i), b = static_cast<float>(y - j);
  const auto at = [&](int column, int row) {
    column = std::min(column, table.width - 1);
    row = std::min(row, table.height - 1);
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(table.width) +
                  static_cast<std::size_t>(column)];
  };
  return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) + b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
}

/// Every `factor` x `factor` pixels become one.
void shrink(int factor, PinholeCamera& camera, UndistortionTable& table) {
  UndistortionTable smaller;
  smaller.width = camera.width / factor;
  smaller.height = camera.height / factor;
  for (int y = 0; y < smaller.height; ++y) {
    for (int x = 0; x < smaller.width; ++x) {
      const double from_x = (x + 0.5) * factor - 0.5, from_y = (y + 0.5) * factor - 0.5;
      smaller.source_x.push_back(table.empty() ? static_cast<float>(from_x)
                                               : sample(table, table.source_x, from_x, from_y));
      smaller.source_y.push_back(table.empty() ? static_cast<float>(from_y)
                                               : sample(table, table.source_y, from_x, from_y));
    }
  }
  table = std::move(smaller);
  camera.fx /= factor;
  camera.fy /= factor;
  camera.cx = (camera.cx + 0.5) / factor - 0.5;
  camera.cy = (camera.cy + 0.5) / factor - 0.5;
  camera.width /= factor;
  camera.height /= factor;
}

double focal_length(const PinholeCamera& camera) { return std::sqrt(camera.fx * camera.fy); }

}  // namespace

StereoRig with_equal_scales(StereoRig rig) {
  const double ratio = focal_length(rig.left) / focal_length(rig.right);
  if (ratio >= kMuchFiner) shrink(static_cast<int>(std::lround(ratio)), rig.left, rig.left_undistortion);
  if (1 / ratio >= kMuchFiner) shrink(static_cast<int>(std::lround(1 / ratio)), rig.right, rig.right_undistortion);
  return rig;
}

}  // namespace quadedge::odometry
