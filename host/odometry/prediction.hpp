#pragma once
/// \file prediction.hpp  Where the previous stereo edges are expected in the current images.

#include <Eigen/Geometry>
#include <optional>

#include "common/temporal_search.hpp"
#include "pose/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// Moves every stereo edge's oriented point by the predicted motion and projects it into both images; without a
/// prediction the positions and directions stay. Edges without depth, or that leave the field of view, get NaN where a
/// motion is predicted. \param current_from_previous left cameras, metres \param measured the previous edges, see
/// pose::measure_edges() \param radius px; \param step every step-th edge is looked for \param search what is replaced
void predict_positions(const StereoRig& rig, const StereoEdges& previous, const pose::MeasuredEdges& measured,
                       const std::optional<Eigen::Isometry3d>& current_from_previous, double radius, int step,
                       TemporalSearch& search);

/// Edges inside a camera's image.
int count_in_view(const PinholeCamera& camera, const EdgePositions& edges);

/// Mean distance of every step-th position that both hold [px]; 0 where there is none.
double mean_distance(const EdgePositions& a, const EdgePositions& b, int step);

}  // namespace quadedge::odometry
