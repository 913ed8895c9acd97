#pragma once
/// \file epipolar_geometry.hpp  Where in the right image the counterpart of a left pixel can lie. General rig,
/// doc/method.md section 3.

#include "common/layouts.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

/// `max_disparity` of the configuration counts where it is positive, else `min_depth`; one of them must be.
/// \throws UsageError when neither limits the search.
EpipolarGeometry make_epipolar_geometry(const StereoRig& rig, const StereoConfig& config);

/// The same geometry with the limits that a tap wants to see opened: all disparities, all orientations.
EpipolarGeometry without_limits(EpipolarGeometry geometry, bool all_disparities, bool all_orientations);

/// Twin of kernels/epipolar.cl: a half line in the right image, from the point of infinite depth towards nearer points.
struct EpipolarLine {
  float x = 0, y = 0;    ///< point of infinite depth [px]
  float ex = 0, ey = 0;  ///< unit direction of growing disparity
  float s_max = 0;       ///< px from that point to the nearest allowed depth
  bool valid = false;
};
EpipolarLine epipolar_line(const EpipolarGeometry& geometry, float x, float y);

/// Sine of the angle between an edge's tangent and the left epipolar line through it.
float left_epipolar_sine(const EpipolarGeometry& geometry, float x, float y, float direction);

}  // namespace quadedge
