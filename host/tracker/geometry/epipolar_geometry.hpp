#pragma once
/// \file epipolar_geometry.hpp  Epipolar geometry of a general rig: where the counterpart of a left pixel can lie in
/// the right image, and the common numbering of the epipolar lines of both. doc/method.md sections 1 and 3.

#include "common/layouts.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/rig_estimate.hpp"

namespace quadedge {

/// The search is limited by `max_disparity` if positive, otherwise by `min_depth`.
/// \throws UsageError if neither is given
EpipolarGeometry make_epipolar_geometry(const StereoRig& rig, const StereoConfig& config);

/// The geometry whose lines pass through the points that lie beside those of the calibration. A slope of `error` along
/// the lines is that of a right camera that is rolled about its optical axis, so that points are displaced along the
/// lines, too: positions on the lines are those without error.
EpipolarGeometry corrected(EpipolarGeometry geometry, const RectificationError& error, const StereoRig& rig);

/// The same geometry with limits removed, for taps: all disparities, all orientations.
EpipolarGeometry without_limits(EpipolarGeometry geometry, bool all_disparities, bool all_orientations);

/// Twin of kernels/epipolar.cl: a half line in the right image, from the point at infinite depth towards nearer points.
struct EpipolarLine {
  float x = 0, y = 0;    ///< point at infinite depth [px]
  float ex = 0, ey = 0;  ///< unit direction of increasing disparity
  float s_max = 0;       ///< distance from that point to the nearest permitted depth [px]
  bool valid = false;
};
EpipolarLine epipolar_line(const EpipolarGeometry& geometry, float x, float y);

/// Sine of the angle between an edge and the left epipolar line through it.
float left_epipolar_sine(const EpipolarGeometry& geometry, float x, float y, float direction);

/// Numbering of an image's epipolar lines: angles of the epipolar planes, as tangents times the left focal length. The
/// plane half-way between the two optical axes has number 0.
EpipolarRows epipolar_rows(const StereoRig& rig, Side side);

/// Arguments of kernels/edge_selection.cl for an image. The right image, which is searched, keeps slightly more edges.
/// \param error of the right image's rows, which are numbered as they lie in it
SelectionArguments selection_arguments(const StereoRig& rig, Side side, const RectificationError& error = {});

}  // namespace quadedge
