#pragma once
/// \file noise_model.hpp  How exactly edges are measured.

#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Standard deviations of an edge's measurement.
struct NoiseModel {
  explicit NoiseModel(const PoseConfig& config);
  double across, along;  ///< of an edge's position across and along itself [px]
  double direction;      ///< of an edge's direction [rad]
  /// Of a position on the epipolar line, for an edge that crosses the line under an angle of sine `epipolar_sine` [px].
  double on_epipolar_line(double epipolar_sine) const;
};

}  // namespace quadedge::pose
