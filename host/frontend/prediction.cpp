#include "frontend/prediction.hpp"

#include <cmath>
#include <limits>

#include "common/row_blocks.hpp"
#include "pose/oriented_point.hpp"

namespace quadedge::frontend {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

void set(EdgePositions& edges, std::size_t i, const std::optional<pose::ImageEdge>& edge) {
  edges.x[i] = edge ? static_cast<float>(edge->pixel.x()) : kNowhere;
  edges.y[i] = edge ? static_cast<float>(edge->pixel.y()) : kNowhere;
  edges.direction[i] = edge ? static_cast<float>(std::atan2(edge->direction.y(), edge->direction.x())) : kNowhere;
}

/// Assigns to vectors that keep their memory.
void set_without_motion(const StereoEdges& previous, double radius, TemporalSearch& search) {
  search.radius = static_cast<float>(radius);
  search.coarse = false;
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
  set_without_motion(previous, coarse ? config.coarse_radius : config.radius, search);
  search.coarse = coarse;
  return search;
}

void predict_positions(const StereoRig& rig, const StereoEdges& previous, const pose::MeasuredEdges& measured,
                       const std::optional<Eigen::Isometry3d>& current_from_previous, double radius, int step,
                       TemporalSearch& search) {
  set_without_motion(previous, radius, search);
  search.step = step;
  if (!current_from_previous) return;
  const Eigen::Isometry3d right_from_previous = rig.right_from_left * *current_from_previous;
  const auto predict = [&](std::size_t i) {
    std::optional<pose::OrientedPoint> point;
    if (measured[i]) point = measured[i]->oriented_point();
    set(search.left, i, point ? pose::project(rig.left, *current_from_previous, *point) : std::nullopt);
    set(search.right, i, point ? pose::project(rig.right, right_from_previous, *point) : std::nullopt);
  };
  const auto every = static_cast<std::size_t>(step);
  for_row_blocks((previous.size() + every - 1) / every, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) predict(row * every);
  });
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
