#pragma once
/// \file epipolar_geometry.hpp  Epipolar geometry of a general rig: where the counterpart of a left pixel can lie in
/// the right image. doc/method.md section 3.

#include "common/layouts.hpp"
#include "common/rectification_error.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

/// The search is limited by `max_disparity` if positive, otherwise by `min_depth`.
/// \throws UsageError if neither is given
EpipolarGeometry make_epipolar_geometry(const StereoRig& rig, const StereoConfig& config);

/// The geometry whose lines pass through the points that lie beside those of the calibration. A change of `error` along
/// the lines is that of a right camera that is rolled about its optical axis, so that points are displaced along the
/// lines, too: positions on the lines are those without error. \param left the camera that `error` refers to
EpipolarGeometry corrected(EpipolarGeometry geometry, const RectificationError& error, const PinholeCamera& left);

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

}  // namespace quadedge
