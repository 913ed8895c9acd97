#include "evaluation/surface_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadedge::evaluation {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kNormalStep = 0.5;  // px between samples along the normal

template <class Values, class Convert>
SurfaceMap make_map(int width, int height, const Values& values, const Convert& convert) {
  SurfaceMap map{width, height, {}};
  map.nearness.reserve(values.size());
  for (const auto value : values) {
    const double nearness = convert(static_cast<double>(value));
    map.nearness.push_back(std::isfinite(nearness) && nearness > 0 ? static_cast<float>(nearness) : kUnknown);
  }
  return map;
}

/// Bilinear interpolation over the pixels on the same surface as the nearest pixel.
double interpolate(const SurfaceMap& map, double x, double y, double surface) {
  const double x0 = std::floor(x), y0 = std::floor(y);
  double sum = 0, weights = 0;
  for (int k = 0; k < 4; ++k) {
    const double px = x0 + k % 2, py = y0 + k / 2;
    const float value = map.nearest(px, py);
    if (!(std::abs(value - surface) <= kDepthStep)) continue;
    const double weight = (1 - std::abs(px - x)) * (1 - std::abs(py - y));
    sum += weight * value;
    weights += weight;
  }
  return weights > 0 ? sum / weights : surface;
}

}  // namespace

float SurfaceMap::nearest(double x, double y) const {
  const double column = std::round(x), row = std::round(y);
  if (!(column >= 0 && row >= 0 && column < width && row < height)) return kUnknown;
  return nearness[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
}

SurfaceMap surface_from_disparity(const data::FloatMap& disparity, double scale) {
  return make_map(disparity.width, disparity.height, disparity.values, [&](double value) { return value * scale; });
}

SurfaceMap surface_from_grey(const Image& disparity, double scale) {
  std::vector<int> values;
  for (int y = 0; y < disparity.height; ++y)
    for (int x = 0; x < disparity.width; ++x) values.push_back(disparity.view().value(x, y));
  return make_map(disparity.width, disparity.height, values, [&](double value) { return value * scale; });
}

SurfaceMap surface_from_depth(const data::FloatMap& depth, double focal_times_baseline) {
  return make_map(depth.width, depth.height, depth.values, [&](double value) { return focal_times_baseline / value; });
}

std::optional<SurfacePoint> surface_at(const SurfaceMap& map, double x, double y, double direction) {
  const double nx = -std::sin(direction), ny = std::cos(direction);
  double nearest = -1, farthest = std::numeric_limits<double>::infinity();
  for (double s = -kContourReach; s <= kContourReach; s += kNormalStep) {
    const float value = map.nearest(x + s * nx, y + s * ny);
    if (std::isnan(value)) return std::nullopt;
    nearest = std::max<double>(nearest, value);
    farthest = std::min<double>(farthest, value);
  }
  if (nearest - farthest <= kDepthStep) {
    for (double s = kContourReach + kNormalStep; s <= kDoubtReach; s += kNormalStep) {
      for (const double side : {-s, s}) {
        if (map.nearest(x + side * nx, y + side * ny) - nearest > kDepthStep) return std::nullopt;
      }
    }
    return SurfacePoint{interpolate(map, x, y, map.nearest(x, y)), false};
  }
  double sum = 0, weights = 0;
  for (double s = -kContourReach; s <= kContourReach; s += kNormalStep) {
    const float value = map.nearest(x + s * nx, y + s * ny);
    if (nearest - value > kDepthStep) continue;
    const double weight = std::exp(-2 * s * s);
    sum += weight * value;
    weights += weight;
  }
  return SurfacePoint{sum / weights, true};
}

Visibility visibility(const SurfaceMap& map, double x, double y, double nearness) {
  if (!(x >= 0 && y >= 0 && x <= map.width - 1 && y <= map.height - 1)) return Visibility::occluded;
  int nearer = 0, farther = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const float value = map.nearest(std::round(x) + dx, std::round(y) + dy);
      if (std::isnan(value)) continue;
      if (std::abs(value - nearness) <= kDepthStep) return Visibility::visible;
      ++(value > nearness ? nearer : farther);
    }
  }
  return nearer > 0 && farther == 0 ? Visibility::occluded : Visibility::unknown;
}

SurfaceMap right_from_left(const SurfaceMap& left, int right_width) {
  SurfaceMap right{
      right_width, left.height,
      std::vector<float>(static_cast<std::size_t>(right_width) * static_cast<std::size_t>(left.height), kUnknown)};
  const auto put = [&](int row, double column, double value) {
    if (!(column >= 0 && column < right_width)) return;
    float& nearest = right.nearness[static_cast<std::size_t>(row) * static_cast<std::size_t>(right_width) +
                                    static_cast<std::size_t>(column)];
    if (std::isnan(nearest) || value > nearest) nearest = static_cast<float>(value);
  };
  for (int row = 0; row < left.height; ++row) {
    for (int column = 0; column < left.width; ++column) {
      const float value = left.nearest(column, row);
      if (std::isnan(value)) continue;
      put(row, std::round(column - value), value);
      const float next = left.nearest(column + 1, row);
      if (!(std::abs(next - value) <= kDepthStep)) continue;
      const double from = column - value, to = column + 1 - next;
      for (double at = std::ceil(std::min(from, to)); at <= std::max(from, to); ++at) {
        put(row, at, value + (next - value) * (from == to ? 0 : (at - from) / (to - from)));
      }
    }
  }
  return right;
}

}  // namespace quadedge::evaluation
