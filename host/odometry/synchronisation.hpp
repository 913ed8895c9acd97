#pragma once
/// \file synchronisation.hpp  Whether both cameras see the same moment.

#include <Eigen/Core>

namespace quadedge::odometry {

/// A right camera that is t frames late shows every spot where it was t frames ago: its distance from the epipolar line
/// follows the image's motion across that line. A wrong calibration causes distances too, the same in every frame:
/// linear least squares over all frames so far,
///   across = (a polynomial of the second degree in u and v) - t motion.
class Synchronisation {
 public:
  /// \param u, v position in the left image, -1/2 to 1/2 \param across distance from the epipolar line [px]
  /// \param motion of the spot across the line over the last frame interval [px]
  void add(double u, double v, double across, double motion);

  /// Frame intervals that the right camera is late, below zero for the left one; 0 where it is not significant.
  double time_offset_frames() const;

 private:
  using Terms = Eigen::Matrix<double, 7, 1>;
  Eigen::Matrix<double, 7, 7> normal_ = Eigen::Matrix<double, 7, 7>::Zero();
  Terms right_side_ = Terms::Zero();
  double squares_ = 0;
  int count_ = 0;
};

}  // namespace quadedge::odometry
