#include "evaluation/filter_table.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/numeric.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge::evaluation {
namespace {

/// Fundamental matrix: the epipolar line of a left pixel p is F p.
Eigen::Matrix3d fundamental_matrix(const StereoRig& rig) {
  const Eigen::Vector3d t = rig.right_from_left.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  return rig.right.matrix().inverse().transpose() * cross * rig.right_from_left.linear() * rig.left.matrix().inverse();
}

Pools empty_pools(std::size_t size) { return {std::vector<std::uint8_t>(size, 0), std::vector<std::uint8_t>(size, 0)}; }

}  // namespace

void FilterCounts::add_edge(std::int64_t candidates_of_edge, std::int64_t veridical_of_edge) {
  ++pool;
  found += veridical_of_edge > 0 ? 1 : 0;
  alive += candidates_of_edge > 0 ? 1 : 0;
  candidates += candidates_of_edge;
  veridical += veridical_of_edge;
  most_candidates = std::max(most_candidates, candidates_of_edge);
  if (candidates_of_edge > 0) precisions += ratio(veridical_of_edge, candidates_of_edge);
}

void FilterCounts::add(const FilterCounts& other) {
  pool += other.pool;
  found += other.found;
  alive += other.alive;
  candidates += other.candidates;
  veridical += other.veridical;
  most_candidates = std::max(most_candidates, other.most_candidates);
  precisions += other.precisions;
}

double FilterCounts::recall() const { return ratio(found, pool); }
double FilterCounts::precision() const { return ratio(veridical, candidates); }
double FilterCounts::precision_per_edge() const { return alive > 0 ? precisions / static_cast<double>(alive) : kNan; }
double FilterCounts::ambiguity_mean() const { return ratio(candidates, alive) - 1; }
double FilterCounts::ambiguity_of_pool() const { return ratio(candidates, pool) - 1; }
double FilterCounts::ambiguity_max() const {
  return most_candidates > 0 ? static_cast<double>(most_candidates - 1) : std::numeric_limits<double>::quiet_NaN();
}

void add(FilterTable& sum, const FilterTable& other) {
  if (sum.empty()) {
    sum = other;
    return;
  }
  if (other.empty()) return;
  if (sum.size() != other.size()) throw UsageError("tables of different filters cannot be pooled");
  for (std::size_t row = 0; row < sum.size(); ++row) {
    if (sum[row].order != other[row].order) throw UsageError("tables of different filters cannot be pooled");
    sum[row].paired.add(other[row].paired);
    sum[row].all.add(other[row].all);
  }
}

bool is_veridical(const TruePositions& truth, std::size_t i, double x, double y, const MatchingTolerance& tolerance) {
  if (truth.state[i] != Visibility::visible) return false;
  return std::hypot(x - truth.x[i], y - truth.y[i]) <= tolerance.position;
}

FilterRow judge(int order, const std::string& filter, const CandidateLists& lists, const std::vector<float>& target_x,
                const std::vector<float>& target_y, const TruePositions& truth, const Pools& pools,
                const MatchingTolerance& tolerance) {
  const bool refined = lists.x.size() == lists.target.size();
  FilterRow row{order, filter, {}, {}};
  for (std::size_t i = 0; i + 1 < lists.first.size(); ++i) {
    if (pools.all[i] == 0) continue;
    std::int64_t veridical = 0;
    for (auto k = static_cast<std::size_t>(lists.first[i]); k < static_cast<std::size_t>(lists.first[i + 1]); ++k) {
      const auto target = static_cast<std::size_t>(lists.target[k]);
      const float x = refined ? lists.x[k] : target_x[target], y = refined ? lists.y[k] : target_y[target];
      veridical += is_veridical(truth, i, x, y, tolerance) ? 1 : 0;
    }
    const std::int64_t candidates = lists.first[i + 1] - lists.first[i];
    row.all.add_edge(candidates, veridical);
    if (pools.paired[i] != 0) row.paired.add_edge(candidates, veridical);
  }
  return row;
}

FilterRow judge_baseline(const std::string& filter, const std::vector<float>& target_x,
                         const std::vector<float>& target_y, int image_height, const TruePositions& truth,
                         const Pools& pools, const MatchingTolerance& tolerance) {
  const NearbyTargets nearby(target_x, target_y, image_height);
  FilterRow row{0, filter, {}, {}};
  for (std::size_t i = 0; i < pools.all.size(); ++i) {
    if (pools.all[i] == 0) continue;
    std::int64_t veridical = 0;
    if (truth.state[i] == Visibility::visible) {
      nearby.visit(truth.x[i], truth.y[i], tolerance.position, [&](std::size_t) { ++veridical; });
    }
    const auto candidates = static_cast<std::int64_t>(target_x.size());
    row.all.add_edge(candidates, veridical);
    if (pools.paired[i] != 0) row.paired.add_edge(candidates, veridical);
  }
  return row;
}

double line_angle_deg(double a, double b) { return std::abs(std::remainder(a - b, kPi)) * 180 / kPi; }

Pools stereo_pools(const StereoRig& rig, const EdgeSet& left, const EdgeSet& right, const TruePositions& truth,
                   double min_epipolar_angle, const MatchingTolerance& tolerance) {
  const Eigen::Matrix3d f = fundamental_matrix(rig);
  // The left epipole: image of the right camera's centre.
  const Eigen::Vector3d epipole = rig.left.matrix() * (rig.right_from_left.inverse() * Eigen::Vector3d::Zero());
  const NearbyTargets nearby(right.x, right.y, rig.right.height);
  Pools pools = empty_pools(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (truth.state[i] == Visibility::unknown) continue;
    const Eigen::Vector3d pixel(left.x[i], left.y[i], 1);
    const Eigen::Vector2d along = epipole.head<2>() - epipole.z() * pixel.head<2>();
    if (line_angle_deg(left.direction[i], std::atan2(along.y(), along.x())) < min_epipolar_angle) continue;
    pools.all[i] = 1;
    if (truth.state[i] != Visibility::visible) continue;
    const Eigen::Vector3d line = f * pixel;
    const double norm = line.head<2>().norm();
    nearby.visit(truth.x[i], truth.y[i], tolerance.position, [&](std::size_t j) {
      const double distance = std::abs(line.dot(Eigen::Vector3d(right.x[j], right.y[j], 1))) / norm;
      if (distance > tolerance.line ||
          line_angle_deg(left.direction[i], right.direction[j]) > tolerance.stereo_direction)
        return;
      pools.paired[i] = 1;
    });
  }
  return pools;
}

Pools temporal_pools(const std::vector<float>& previous_direction,
                     const std::vector<std::uint8_t>& previous_is_veridical, const EdgePositionsView& current,
                     int image_height, const TruePositions& truth, const MatchingTolerance& tolerance) {
  const NearbyTargets nearby(current.x, current.y, image_height);
  Pools pools = empty_pools(previous_direction.size());
  for (std::size_t i = 0; i < previous_direction.size(); ++i) {
    if (truth.state[i] == Visibility::unknown) continue;
    pools.all[i] = 1;
    if (truth.state[i] != Visibility::visible || previous_is_veridical[i] == 0) continue;
    nearby.visit(truth.x[i], truth.y[i], tolerance.position, [&](std::size_t j) {
      if (line_angle_deg(previous_direction[i], current.direction[j]) <= tolerance.temporal_direction)
        pools.paired[i] = 1;
    });
  }
  return pools;
}

Pools quad_pools(const StereoEdges& previous, const std::vector<std::uint8_t>& previous_is_veridical,
                 const StereoEdges& current, int image_height, const TruePositions& left_truth,
                 const TruePositions& right_truth, const MatchingTolerance& tolerance) {
  const NearbyTargets nearby(current.left_x, current.left_y, image_height);
  Pools pools = empty_pools(previous.size());
  for (std::size_t i = 0; i < previous.size(); ++i) {
    if (left_truth.state[i] == Visibility::unknown || right_truth.state[i] == Visibility::unknown) continue;
    pools.all[i] = 1;
    if (left_truth.state[i] != Visibility::visible || previous_is_veridical[i] == 0) continue;
    nearby.visit(left_truth.x[i], left_truth.y[i], tolerance.position, [&](std::size_t j) {
      if (!is_veridical(right_truth, i, current.right_x[j], current.right_y[j], tolerance)) return;
      if (line_angle_deg(previous.left_direction[i], current.left_direction[j]) > tolerance.temporal_direction) return;
      if (line_angle_deg(previous.right_direction[i], current.right_direction[j]) > tolerance.temporal_direction)
        return;
      pools.paired[i] = 1;
    });
  }
  return pools;
}

}  // namespace quadedge::evaluation
