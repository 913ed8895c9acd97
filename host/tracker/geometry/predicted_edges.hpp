#pragma once
/// \file predicted_edges.hpp  Where measured edges are seen after a motion, for several edges at once.

#include <Eigen/Geometry>
#include <cstddef>

#include "geometry/measured_edges.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::pose {

/// Moves the oriented point of every `step`-th measured edge and projects it into both cameras, as project() does.
/// \param current_from_previous left cameras, metres
/// \param left, right one entry per edge: positions [px] and directions [rad, accurate to 1e-7] in both images; NaN for
/// an edge without a measurement, a point that is not in front of the camera, and a tangent that points at its centre
void predict_edges(const StereoRig& rig, const MeasuredEdges& measured, const Eigen::Isometry3d& current_from_previous,
                   std::size_t step, EdgePositions& left, EdgePositions& right);

}  // namespace quadedge::pose
