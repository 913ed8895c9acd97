#pragma once
/// \file measured_edges.hpp  The stereo edges of a frame, measured by its rig, and where they are seen after a motion.

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "geometry/oriented_point.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::pose {

/// Measurements of all stereo edges of a frame; nothing for an edge without depth or tangent.
using MeasuredEdges = std::vector<std::optional<StereoMeasurement>>;

/// \param min_epipolar_angle see measure() [rad]
void measure_edges(const StereoRig& rig, const StereoEdges& edges, double min_epipolar_angle, MeasuredEdges& measured);

/// Moves the oriented point of every `step`-th measured edge and projects it into both cameras, as project() does.
/// \param current_from_previous left cameras, metres
/// \param left, right one entry per edge: positions [px] and directions [rad, accurate to 1e-7] in both images; NaN for
/// an edge without a measurement, a point that is not in front of the camera, and a tangent that points at its centre
void predict_edges(const StereoRig& rig, const MeasuredEdges& measured, const Eigen::Isometry3d& current_from_previous,
                   std::size_t step, EdgePositions& left, EdgePositions& right);

}  // namespace quadedge::pose
