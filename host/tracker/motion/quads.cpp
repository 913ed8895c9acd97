/// \file quads.cpp  Fills the columns for scoring; the slopes of tangents are shrunk by a prior.
#include "motion/quads.hpp"

#include "common/matching_constants.hpp"
#include "common/parallel.hpp"

namespace quadedge::pose {

void ScoringArrays::assign_rows(const ScoringArrays& other, const std::vector<std::int32_t>& rows) {
  for (auto column : kScoringColumns) {
    auto& to = this->*column;
    const auto& from = other.*column;
    to.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) to[k] = from[static_cast<std::size_t>(rows[k])];
  }
  half_length = other.half_length;
}

void ScoringArrays::resize(std::size_t rows) {
  for (auto column : kScoringColumns) (this->*column).resize(rows);
}

void QuadObservations::resize(std::size_t quads) {
  previous.resize(quads);
  current.resize(quads);
  scoring.resize(quads);
  ncc.resize(quads);
  competing_clusters.resize(quads);
  match.resize(quads);
}

void QuadObservations::set(std::size_t i, const StereoMeasurement& before, const StereoMeasurement& after,
                           const StereoObservation& current_edge, float ncc_value, std::int32_t competing,
                           std::int32_t match_number, double direction_sigma) {
  previous[i] = before;
  current[i] = after;
  const double uncertainty = before.slope_per_radian * direction_sigma / kSlopePrior;
  const Eigen::Vector3d tangent =
      (before.direction + before.slope / (1.0 + uncertainty * uncertainty) * before.ray).normalized();
  scoring.ray_x[i] = static_cast<float>(before.ray.x());
  scoring.ray_y[i] = static_cast<float>(before.ray.y());
  scoring.inverse_depth[i] = static_cast<float>(before.inverse_depth);
  scoring.tangent_x[i] = static_cast<float>(tangent.x());
  scoring.tangent_y[i] = static_cast<float>(tangent.y());
  scoring.tangent_z[i] = static_cast<float>(tangent.z());
  scoring.left_x[i] = static_cast<float>(current_edge.left.x());
  scoring.left_y[i] = static_cast<float>(current_edge.left.y());
  scoring.left_cos[i] = after.left_edge.x();
  scoring.left_sin[i] = after.left_edge.y();
  scoring.right_x[i] = static_cast<float>(current_edge.right.x());
  scoring.right_y[i] = static_cast<float>(current_edge.right.y());
  scoring.right_cos[i] = after.right_edge.x();
  scoring.right_sin[i] = after.right_edge.y();
  ncc[i] = ncc_value;
  competing_clusters[i] = competing;
  match[i] = match_number;
}

QuadObservations build_quads(const StereoRig& rig, const StereoEdges& previous, const StereoEdges& current,
                             const TemporalMatches& matches) {
  MeasuredEdges before, after;
  measure_edges(rig, previous, kMinEpipolarAngle, before);
  measure_edges(rig, current, kMinEpipolarAngle, after);
  QuadObservations quads;
  QuadBuilder().build(before, current, after, matches, quads);
  return quads;
}

void QuadBuilder::build(const MeasuredEdges& previous, const StereoEdges& current,
                        const MeasuredEdges& current_measured, const TemporalMatches& matches,
                        QuadObservations& quads) {
  const auto before = [&](std::size_t i) -> const auto& {
    return previous[static_cast<std::size_t>(matches.previous[i])];
  };
  const auto after = [&](std::size_t i) -> const auto& {
    return current_measured[static_cast<std::size_t>(matches.current[i])];
  };
  rows_.clear();
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (before(i) && after(i)) rows_.push_back(i);
  quads.resize(rows_.size());
  for_row_blocks(rows_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const std::size_t i = rows_[q];
      quads.set(q, *before(i), *after(i), observation_of(current, static_cast<std::size_t>(matches.current[i])),
                matches.ncc[i], matches.competing_clusters[i], static_cast<std::int32_t>(i));
    }
  });
}

float QuadBuilder::half_length(double spacing) {
  constexpr double kFarthest =
      1.41421356;  // spacing of two neighbouring edges of a curve: kernels/edge_selection.cl, density_of()
  return static_cast<float>(0.5 * kFarthest * spacing);
}

}  // namespace quadedge::pose
