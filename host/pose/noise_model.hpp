#pragma once
/// \file noise_model.hpp  How exactly edges are measured.

#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Standard deviations of an edge's measurement.
struct NoiseModel {
  explicit NoiseModel(const PoseConfig& config);
  double across, along;  ///< of an edge's position across and along itself [px]
  /// Of a position along an edge that stands for `half_length` px of its curve to both sides, against the same place at
  /// another time. \param scale by which the other standard deviations turn out to be wrong; this one is known [1]
  double along_in_time(double half_length, double scale) const;
  double direction;  ///< of an edge's direction [rad]
  /// Of a position on the epipolar line, for an edge that crosses the line under an angle of sine `epipolar_sine` [px].
  double on_epipolar_line(double epipolar_sine) const;
};

}  // namespace quadedge::pose
