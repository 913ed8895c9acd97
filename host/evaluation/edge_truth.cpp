#include "evaluation/edge_truth.hpp"

#include <cmath>
#include <limits>

namespace quadedge::evaluation {
namespace {

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
