#pragma once
/// \file disparity_offset.hpp  The offset of all disparities that a rectification leaves, learned along the way.

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// The rig with its right principal point moved, so that all disparities grow by `offset` px. Without tables and masks.
StereoRig with_disparity_offset(const StereoRig& rig, double offset);

/// A rig's disparities may all be wrong by the same part of a pixel (KITTI: 0.2 px and more), which shows in the quads
/// of a moving camera (pose::fit_offset()). This is the scalar Kalman filter over what one frame of each key stereo rig
/// says of it.
class DisparityOffset {
 public:
  DisparityOffset(const StereoRig& rig, const PoseConfig& config);

  /// Takes in what one frame found beyond the offset known before, and its variance with the prior [px, px^2]; `frames`
  /// have passed since the last time.
  void update(double correction, double variance, int frames);

  /// The rig with its right principal point moved by the offset, so that right points mean what they should. Without
  /// undistortion tables.
  const StereoRig& rig() const { return rig_; }
  double value() const { return value_; }        ///< px, added to a disparity
  double variance() const { return variance_; }  ///< px^2, of the next frame; 0: disparities are taken as exact

 private:
  StereoRig calibration_;  ///< without tables
  StereoRig rig_;
  double drift_;
  double value_ = 0, variance_;
};

}  // namespace quadedge::odometry
