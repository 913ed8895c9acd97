#pragma once
/// \file epipolar_geometry.hpp  Where in the right image the counterpart of a left pixel can lie. General rig,
/// doc/method.md section 3.

#include <array>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

/// The rig and the limits of the search in single precision, as kernels and reference use them.
///
/// A left pixel p seen at depth Z projects to h + t / Z (homogeneous), h = K_R R0 K_L^-1 (p, 1), t = K_R T0: its
/// epipolar line starts at the point of infinite depth and runs towards nearer points. Positions on the line are
/// measured by `s`, pixels from the point at infinity; on a rectified rig s is the disparity.
struct EpipolarGeometry {
  std::array<float, 9> h;  ///< K_R R0 K_L^-1, row-major
  std::array<float, 3> t;  ///< K_R T0
  std::array<float, 3>
      epipole;              ///< left epipole, homogeneous: the left line through p runs along epipole.xy - epipole.z p
  float inverse_min_depth;  ///< 1/m; 0 where max_disparity limits the search
  float max_disparity;      ///< px
  float tolerance;          ///< beyond either end of the segment, px
  float epipolar_distance;  ///< px
  float orientation;        ///< rad, modulo half a turn
  float min_epipolar_sine;  ///< sine of the smallest angle between an edge and its left epipolar line

  /// The fields in this order, for a kernel.
  std::vector<float> packed() const;
};
inline constexpr int kEpipolarGeometryFloats = 21;

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
