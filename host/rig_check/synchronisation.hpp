#pragma once
/// \file synchronisation.hpp  Estimates the time offset between the two cameras.

#include <Eigen/Core>

namespace quadedge::rig_check {

/// If the right camera lags by t frame intervals, it shows points where they were t intervals ago, so that their
/// distance from the epipolar line is proportional to the image motion across that line. Calibration errors also cause
/// distances, but the same in every frame. Linear least squares over all frames so far:
///   across = (a quadratic polynomial in u and v) - t motion.
class Synchronisation {
 public:
  /// \param u, v position in the left image, -1/2 to 1/2 \param across distance from the epipolar line [px]
  /// \param motion displacement across the line over the last frame interval [px]
  void add(double u, double v, double across, double motion);

  /// Lag of the right camera in frame intervals, negative if the left one lags; 0 if not significant or
  /// implausibly large.
  double time_offset_frames() const;

 private:
  using Terms = Eigen::Matrix<double, 7, 1>;
  Eigen::Matrix<double, 7, 7> normal_ = Eigen::Matrix<double, 7, 7>::Zero();
  Terms right_side_ = Terms::Zero();
  double squares_ = 0;
  int count_ = 0;
};

}  // namespace quadedge::rig_check
