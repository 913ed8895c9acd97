#include "odometry/equal_scale.hpp"

#include <cmath>

#include "odometry/bilinear.hpp"

namespace quadedge::odometry {
namespace {

constexpr double kMuchFiner = 1.5;

/// Every `factor` x `factor` pixels become one.
void shrink(int factor, PinholeCamera& camera, UndistortionTable& table) {
  UndistortionTable smaller;
  smaller.width = camera.width / factor;
  smaller.height = camera.height / factor;
  for (int y = 0; y < smaller.height; ++y) {
    for (int x = 0; x < smaller.width; ++x) {
      const double from_x = (x + 0.5) * factor - 0.5, from_y = (y + 0.5) * factor - 0.5;
      smaller.source_x.push_back(table.empty() ? static_cast<float>(from_x)
                                               : bilinear(table, table.source_x, from_x, from_y));
      smaller.source_y.push_back(table.empty() ? static_cast<float>(from_y)
                                               : bilinear(table, table.source_y, from_x, from_y));
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
