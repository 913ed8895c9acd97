#pragma once
/// \file prediction.hpp  Predicts the positions of earlier stereo edges in the current images.

#include <Eigen/Geometry>
#include <optional>

#include "common/filter_limits.hpp"
#include "geometry/measured_edges.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::frontend {

/// A coarse or guided search for all edges around their previous positions.
TemporalSearch search_without_motion(const StereoEdges& previous, const TemporalConfig& config, bool coarse);

/// Transforms every stereo edge's oriented point by the predicted motion and projects it into both images; without a
/// prediction, positions and directions are unchanged. With a prediction, edges without depth and edges outside the
/// field of view become NaN. \param current_from_previous left cameras, metres \param measured the previous edges, see
/// pose::measure_edges() \param radius [px] \param step every step-th edge is predicted \param search is replaced
void predict_positions(const StereoRig& rig, const StereoEdges& previous, const pose::MeasuredEdges& measured,
                       const std::optional<Eigen::Isometry3d>& current_from_previous, double radius, int step,
                       TemporalSearch& search);

/// Number of edges within a camera's image.
int count_in_view(const PinholeCamera& camera, const EdgePositions& edges);

/// Mean distance between corresponding finite positions, over every step-th edge [px]; 0 if there are none.
double mean_distance(const EdgePositions& a, const EdgePositions& b, int step);

}  // namespace quadedge::frontend
