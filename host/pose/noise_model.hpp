#pragma once
/// \file noise_model.hpp  Noise of edge measurements.

#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Standard deviations of an edge's measurement.
struct NoiseModel {
  explicit NoiseModel(const PoseConfig& config);
  double across, along;  ///< of an edge's position across and along itself [px]
  /// Standard deviation along an edge that represents `half_length` px of its curve to both sides, relative to the same
  /// point at another time. \param scale factor by which the other standard deviations are wrong; this one is exact [1]
  double along_in_time(double half_length, double scale) const;
  double direction;  ///< of an edge's direction [rad]
  /// Standard deviation along the epipolar line, for an edge that crosses the line at an angle of sine `epipolar_sine`
  /// [px].
  double on_epipolar_line(double epipolar_sine) const;
};

}  // namespace quadedge::pose
