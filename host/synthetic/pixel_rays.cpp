#include "synthetic/pixel_rays.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

#include "common/lens_mapping.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::synthetic {
namespace {

const double kWidest = std::tan(80 * kDegree);

}  // namespace

PixelRays::PixelRays(const Lens& lens) : camera_(lens.camera), pinhole_(lens.camera) {
  if (lens.is_pinhole()) return;
  const LensMapping mapping(lens);
  table_.resize(index(0, camera_.height + 1));
  const auto look = [&](double x, double y, Eigen::Vector2d& at) {
    const auto ray = mapping.ray({x, y});
    if (!ray || ray->z() <= 0 || ray->head<2>().norm() > kWidest * ray->z()) return false;
    at = ray->hnormalized();
    return true;
  };
  std::vector<char> corner_seen(table_.size());
  tbb::parallel_for(0, camera_.height + 1, [&](int y) {
    for (int x = 0; x <= camera_.width; ++x) {
      Pixel& pixel = table_[index(x, y)];
      pixel.seen = look(x, y, pixel.centre);
      corner_seen[index(x, y)] = look(x - 0.5, y - 0.5, pixel.corner) ? 1 : 0;
    }
  });
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      bool& seen = table_[index(x, y)].seen;
      for (const std::size_t corner : {index(x, y), index(x + 1, y), index(x, y + 1), index(x + 1, y + 1)})
        seen = seen && corner_seen[corner] != 0;
    }
  }
  // Large enough for every visible ray.
  pinhole_.width = pinhole_.height = 2 * static_cast<int>(std::ceil(kWidest * camera_.fx)) + 1;
  pinhole_.fy = pinhole_.fx;
  pinhole_.cx = pinhole_.cy = 0.5 * (pinhole_.width - 1);
}

Eigen::Vector3d PixelRays::centre(int x, int y) const {
  if (table_.empty()) return camera_.ray(Eigen::Vector2d(x, y));
  return table_[index(x, y)].centre.homogeneous();
}

Eigen::Vector3d PixelRays::corner(int x, int y) const {
  if (table_.empty()) return camera_.ray({x - 0.5, y - 0.5});
  return table_[index(x, y)].corner.homogeneous();
}

Eigen::Matrix2d PixelRays::spread(int x, int y) const {
  const auto at = [&](int column, int row) -> const Eigen::Vector2d& { return table_[index(column, row)].corner; };
  Eigen::Matrix2d sides;
  sides << 0.5 * (at(x + 1, y) - at(x, y) + at(x + 1, y + 1) - at(x, y + 1)),
      0.5 * (at(x, y + 1) - at(x, y) + at(x + 1, y + 1) - at(x + 1, y));
  return sides;
}

Eigen::Vector3d PixelRays::within(int x, int y, const Eigen::Vector2d& offset) const {
  if (table_.empty()) return camera_.ray(Eigen::Vector2d(x, y) + offset);
  return (table_[index(x, y)].centre + spread(x, y) * offset).homogeneous();
}

void PixelRays::within(int x, int y, const Eigen::Vector2d* offsets, RayBundle& rays) const {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Eigen::Vector3d ray = within(x, y, offsets[i]);
    rays.x[i] = ray.x();
    rays.y[i] = ray.y();
  }
}

double PixelRays::focal_length(int x, int y) const {
  return table_.empty() ? camera_.fx : 1 / std::sqrt(std::abs(spread(x, y).determinant()));
}

PixelBox PixelRays::footprint(const PixelBox& pixels) const {
  if (table_.empty()) return pixels;
  Eigen::Array2d low(1e9, 1e9), high = -low;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      if (!is_visible(x, y)) continue;
      for (const Eigen::Vector3d& ray : {corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)}) {
        const Eigen::Array2d position = pinhole_.project(ray).array();
        low = low.min(position);
        high = high.max(position);
      }
    }
  }
  if (low.x() > high.x()) return {};
  // Pixels extend around their centres, and sides may bulge by a fraction of a pixel.
  return {static_cast<int>(std::floor(low.x())) - 1, static_cast<int>(std::floor(low.y())) - 1,
          static_cast<int>(std::ceil(high.x())) + 2, static_cast<int>(std::ceil(high.y())) + 2};
}

}  // namespace quadedge::synthetic
