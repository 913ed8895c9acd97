#include "evaluation/edge_truth.hpp"

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

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

bool is_marked_occluded(const FrameTruth& truth, double x, double y) {
  if (truth.occluded.empty()) return false;
  const auto column = static_cast<std::size_t>(std::round(x)), row = static_cast<std::size_t>(std::round(y));
  return truth.occluded[row * static_cast<std::size_t>(truth.left.width) + column] != 0;
}

/// If a view is only predicted from the left map, positions where it is empty are unknown and count as visible.
Visibility visibility_in(const SurfaceMap& map, bool measured, double x, double y, double nearness) {
  const Visibility found = visibility(map, x, y, nearness);
  return found == Visibility::unknown && !measured ? Visibility::visible : found;
}

/// Adds the position, in a camera of `now`, of a point in the left camera frame of `before`.
void push_projection(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_point,
                     const Eigen::Vector3d& point, const SurfaceMap& map, double depth_scale, bool contour,
                     TruePositions& positions) {
  const Eigen::Vector3d seen = camera_from_point * point;
  if (!(seen.z() > 0)) {
    positions.push(kNowhere, kNowhere, Visibility::occluded, contour);
    return;
  }
  const Eigen::Vector2d pixel = camera.project(seen);
  positions.push(pixel.x(), pixel.y(), visibility(map, pixel.x(), pixel.y(), depth_scale / seen.z()), contour);
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
    for (double s = kContourReach + kNormalStep; s <= kUnclearReach; s += kNormalStep) {
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

void TruePositions::reserve(std::size_t size) {
  x.reserve(size);
  y.reserve(size);
  state.reserve(size);
  contour.reserve(size);
}

void TruePositions::push(double at_x, double at_y, Visibility visible, bool on_contour) {
  x.push_back(static_cast<float>(at_x));
  y.push_back(static_cast<float>(at_y));
  state.push_back(visible);
  contour.push_back(on_contour ? 1 : 0);
}

TruePositions true_right_positions(const StereoRig& rig, const FrameTruth& truth, const EdgePositionsView& edges) {
  TruePositions positions;
  positions.reserve(edges.x.size());
  for (std::size_t i = 0; i < edges.x.size(); ++i) {
    const double x = edges.x[i], y = edges.y[i];
    const auto surface = surface_at(truth.left, x, y, edges.direction[i]);
    if (!surface) {
      positions.push(kNowhere, kNowhere, Visibility::unknown, false);
    } else if (truth.depth_scale > 0) {
      push_projection(rig.right, rig.right_from_left, rig.left.ray({x, y}) * (truth.depth_scale / surface->nearness),
                      truth.right, truth.depth_scale, surface->contour, positions);
    } else {
      const double right_x = x - surface->nearness;
      // A contour belongs to the nearer surface, which is visible; the pixel at its position may belong to the farther
      // one.
      const bool marked = !surface->contour && is_marked_occluded(truth, x, y);
      positions.push(right_x, y,
                     marked ? Visibility::occluded
                            : visibility_in(truth.right, truth.right_is_measured, right_x, y, surface->nearness),
                     surface->contour);
    }
  }
  return positions;
}

TruePositions true_later_positions(const StereoRig& rig, const FrameTruth& before, const FrameTruth& now, Side side,
                                   const EdgePositionsView& edges) {
  Eigen::Isometry3d camera_from_before = now.world_from_left.value().inverse() * before.world_from_left.value();
  const bool right = side == Side::right;
  if (right) camera_from_before = rig.right_from_left * camera_from_before;
  const PinholeCamera& camera = right ? rig.right : rig.left;
  TruePositions positions;
  positions.reserve(edges.x.size());
  for (std::size_t i = 0; i < edges.x.size(); ++i) {
    const double x = edges.x[i], y = edges.y[i];
    const auto surface = surface_at(before.left, x, y, edges.direction[i]);
    if (!surface) {
      positions.push(kNowhere, kNowhere, Visibility::unknown, false);
      continue;
    }
    push_projection(camera, camera_from_before, rig.left.ray({x, y}) * (before.depth_scale / surface->nearness),
                    right ? now.right : now.left, now.depth_scale, surface->contour, positions);
  }
  return positions;
}

}  // namespace quadedge::evaluation
