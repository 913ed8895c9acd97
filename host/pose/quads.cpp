#include "pose/quads.hpp"

#include <cmath>

#include "pose/angles.hpp"

namespace quadedge::pose {

namespace {

/// All columns of the arrays, in one order.
constexpr std::vector<float> ScoringArrays::*kColumns[] = {
    &ScoringArrays::ray_x,     &ScoringArrays::ray_y,     &ScoringArrays::inverse_depth, &ScoringArrays::tangent_x,
    &ScoringArrays::tangent_y, &ScoringArrays::tangent_z, &ScoringArrays::left_x,        &ScoringArrays::left_y,
    &ScoringArrays::left_cos,  &ScoringArrays::left_sin,  &ScoringArrays::right_x,       &ScoringArrays::right_y,
    &ScoringArrays::right_cos, &ScoringArrays::right_sin};

StereoObservation observation(const StereoEdges& edges, std::size_t i) {
  return {{edges.left_x[i], edges.left_y[i]}, {edges.right_x[i], edges.right_y[i]}, edges.left_direction[i], edges.right_direction[i]};
}

}  // namespace

QuadLimits::QuadLimits(const Config& config)
    : min_epipolar_angle(radians(config.stereo.min_epipolar_angle)),
      direction_sigma(radians(config.pose.sigma_direction)),
      slope_prior(config.pose.slope_prior) {}

void ScoringArrays::reserve(std::size_t rows) {
  for (auto column : kColumns) (this->*column).reserve(rows);
}

void ScoringArrays::append_row(const ScoringArrays& other, std::size_t row) {
  for (auto column : kColumns) (this->*column).push_back((other.*column)[row]);
}

void QuadObservations::reserve(std::size_t quads) {
  previous.reserve(quads);
  current.reserve(quads);
  previous_points.reserve(quads);
  current_points.reserve(quads);
  scoring.reserve(quads);
  ncc.reserve(quads);
  rivals.reserve(quads);
  match.reserve(quads);
}

bool QuadObservations::append(const StereoRig& rig, const StereoObservation& previous_edge, const StereoObservation& current_edge,
                              float ncc_value, std::int32_t rival_count, std::int32_t match_number, const QuadLimits& limits) {
  const auto before = measure(rig, previous_edge, limits.min_epipolar_angle);
  if (!before) return false;
  const auto after = measure(rig, current_edge, limits.min_epipolar_angle);
  if (!after) return false;
  previous.push_back(*before);
  current.push_back(*after);
  previous_points.push_back(before->oriented_point());
  current_points.push_back(after->oriented_point());
  const double doubt = before->slope_per_radian * limits.direction_sigma / limits.slope_prior;
  const Eigen::Vector3d tangent = (before->direction + before->slope / (1.0 + doubt * doubt) * before->ray).normalized();
  const double values[] = {before->ray.x(), before->ray.y(), before->inverse_depth, tangent.x(), tangent.y(), tangent.z(),
                           current_edge.left.x(), current_edge.left.y(),
                           std::cos(current_edge.left_direction), std::sin(current_edge.left_direction),
                           current_edge.right.x(), current_edge.right.y(),
                           std::cos(current_edge.right_direction), std::sin(current_edge.right_direction)};
  const double* value = values;
  for (auto column : kColumns) (scoring.*column).push_back(static_cast<float>(*value++));
  ncc.push_back(ncc_value);
  rivals.push_back(rival_count);
  match.push_back(match_number);
  return true;
}

QuadObservations build_quads(const StereoRig& rig, const StereoEdges& previous, const StereoEdges& current,
                             const TemporalMatches& matches, const QuadLimits& limits) {
  QuadObservations quads;
  quads.reserve(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    quads.append(rig, observation(previous, static_cast<std::size_t>(matches.previous[i])),
                 observation(current, static_cast<std::size_t>(matches.current[i])), matches.ncc[i],
                 matches.rivals[i], static_cast<std::int32_t>(i), limits);
  }
  return quads;
}

}  // namespace quadedge::pose
