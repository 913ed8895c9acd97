/// \file prediction.cpp  Search positions, as they were or after a predicted motion, and how far they move.
#include "edges/prediction.hpp"

#include <cmath>

namespace quadedge::frontend {
namespace {

/// Assigns to vectors that keep their memory.
void set_without_motion(const StereoEdges& previous, TemporalSearch& search) {
  search.left.x = previous.left_x;
  search.left.y = previous.left_y;
  search.left.direction = previous.left_direction;
  search.right.x = previous.right_x;
  search.right.y = previous.right_y;
  search.right.direction = previous.right_direction;
}

}  // namespace

TemporalSearch search_without_motion(const StereoEdges& previous, const TemporalConfig& config, bool coarse) {
  TemporalSearch search;
  set_without_motion(previous, search);
  search.radius = static_cast<float>(coarse ? config.coarse_radius : config.radius);
  search.coarse = coarse;
  return search;
}

void predict_positions(const StereoRig& rig, const StereoEdges& previous, const pose::MeasuredEdges& measured,
                       const std::optional<Eigen::Isometry3d>& current_from_previous, double radius, int step,
                       TemporalSearch& search) {
  search.radius = static_cast<float>(radius);
  search.coarse = false;
  search.step = step;
  if (!current_from_previous || step > 1) set_without_motion(previous, search);
  if (!current_from_previous) return;
  pose::predict_edges(rig, measured, *current_from_previous, static_cast<std::size_t>(step), search.left, search.right);
}

int count_in_view(const PinholeCamera& camera, const EdgePositions& edges) {
  int count = 0;
  for (std::size_t i = 0; i < edges.x.size(); ++i) {
    const bool inside = edges.x[i] >= 0 && edges.x[i] <= static_cast<float>(camera.width - 1) && edges.y[i] >= 0 &&
                        edges.y[i] <= static_cast<float>(camera.height - 1);  // false for NaN
    count += inside ? 1 : 0;
  }
  return count;
}

double mean_distance(const EdgePositions& a, const EdgePositions& b, int step) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.x.size(); i += static_cast<std::size_t>(step)) {
    const double dx = static_cast<double>(a.x[i] - b.x[i]), dy = static_cast<double>(a.y[i] - b.y[i]);
    const double distance = std::sqrt(dx * dx + dy * dy);
    if (!std::isfinite(distance)) continue;
    sum += distance;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace quadedge::frontend
