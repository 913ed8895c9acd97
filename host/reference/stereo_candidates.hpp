#pragma once
/// \file stereo_candidates.hpp  Plain C++ twin of kernels/stereo_candidates.cl, and the epipolar line of kernels/epipolar.cl.

#include <cstdint>
#include <vector>

#include "quadedge/edges.hpp"
#include "stages/epipolar_geometry.hpp"

namespace quadedge::reference {

/// Candidate lists in compressed rows: row i owns first[i] .. first[i + 1] of target.
struct Candidates {
  std::vector<std::int32_t> first;   ///< rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
};

/// A half line in the right image, from the point of infinite depth towards nearer points.
struct EpipolarLine {
  float x = 0, y = 0;    ///< point of infinite depth [px]
  float ex = 0, ey = 0;  ///< unit direction of growing disparity
  float s_max = 0;       ///< px from that point to the nearest allowed depth
  bool valid = false;
};
EpipolarLine epipolar_line(const stages::EpipolarGeometry& geometry, float x, float y);

/// Sine of the angle between an edge's tangent and the left epipolar line through it.
float left_epipolar_sine(const stages::EpipolarGeometry& geometry, float x, float y, float direction);

/// Smallest difference of two directions modulo a half turn [rad].
float line_angle_between(float a, float b);
/// Smallest difference of two directions modulo a full turn [rad].
float angle_between(float a, float b);

/// Filters 1 to 3 of SPEC section 3 for every left edge. Needs right.row_first only to skip far rows.
Candidates stereo_candidates(const EdgeSet& left, const EdgeSet& right, const stages::EpipolarGeometry& geometry);

}  // namespace quadedge::reference
