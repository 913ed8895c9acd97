#include "common/equal_scale.hpp"

#include <cmath>

#include "common/bilinear.hpp"

namespace quadedge {
namespace {

/// Ratio of the two focal lengths in pixels from which a camera is reduced to a fraction of its resolution: half-way to
/// twice the resolution.
constexpr double kMinScaleRatio = 1.5;

/// Reduces a mask by `factor`; a pixel is hidden if any of its source pixels is.
void shrink(int factor, const PinholeCamera& camera, PixelMask& mask) {
  if (mask.empty()) return;
  PixelMask smaller{camera.width / factor, camera.height / factor, {}};
  const auto at = [&](const PixelMask& grid, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(x);
  };
  smaller.hidden.resize(at(smaller, 0, smaller.height));
  for (int y = 0; y < factor * smaller.height; ++y)
    for (int x = 0; x < factor * smaller.width; ++x)
      if (mask.hidden[at(mask, x, y)] != 0) smaller.hidden[at(smaller, x / factor, y / factor)] = 1;
  mask = std::move(smaller);
}

/// Reduces a camera and its table by `factor`.
void shrink(int factor, PinholeCamera& camera, UndistortionTable& table) {
  UndistortionTable smaller;
  smaller.width = camera.width / factor;
  smaller.height = camera.height / factor;
  smaller.recorded_width = table.empty() ? camera.width : table.recorded_width;
  smaller.recorded_height = table.empty() ? camera.height : table.recorded_height;
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

void shrink_camera(double times, PinholeCamera& camera, UndistortionTable& table, PixelMask& mask) {
  if (times < kMinScaleRatio) return;
  const int factor = static_cast<int>(std::lround(times));
  shrink(factor, camera, mask);
  shrink(factor, camera, table);
}

}  // namespace

StereoRig with_equal_scales(StereoRig rig) {
  const double ratio = focal_length(rig.left) / focal_length(rig.right);
  shrink_camera(ratio, rig.left, rig.left_undistortion, rig.left_mask);
  shrink_camera(1 / ratio, rig.right, rig.right_undistortion, rig.right_mask);
  return rig;
}

StereoRig with_scale_of(const PinholeCamera& camera, StereoRig rig) {
  const double ratio = focal_length(rig.left) / focal_length(camera);
  shrink_camera(ratio, rig.left, rig.left_undistortion, rig.left_mask);
  shrink_camera(ratio, rig.right, rig.right_undistortion, rig.right_mask);
  return rig;
}

}  // namespace quadedge
