#pragma once
/// \file measured_edges.hpp  The stereo edges of a frame, measured by its rig.

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

}  // namespace quadedge::pose
