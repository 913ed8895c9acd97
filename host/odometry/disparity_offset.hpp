#pragma once
/// \file disparity_offset.hpp  Online estimate of the common offset of all disparities.

#include <algorithm>
#include <functional>
#include <map>

#include "odometry/right_camera.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Moves the right principal point so that all disparities increase by `offset` px. The result has no undistortion
/// tables and no masks.
StereoRig with_disparity_offset(const StereoRig& rig, double offset);

/// A scalar Kalman filter for the common offset of a rig's disparities, a rectification error of a fraction of a pixel
/// (KITTI: 0.2 px and more). The offset is observable in the quads of a moving camera (pose::fit_offset()); one frame
/// per key rig contributes a measurement.
class DisparityOffset {
 public:
  DisparityOffset(const StereoRig& rig, const PoseConfig& config);

  /// Adds a measurement: the correction to the current offset and its variance, which includes the prior [px, px^2];
  /// `frames` have passed since the last measurement.
  void update(double correction, double variance, int frames);

  /// Begins a frame, which is assumed not to have jumped. Forgets the jumps of frames that it is not measured against.
  void start_frame(int frame, const std::function<bool(int)>& is_base);
  /// The disparities of the frame are larger by `jump` px than those of the rig at other times, because its right image
  /// is displaced: rig() is that of the frame.
  void set_jump(double jump);
  /// Of a frame; 0 for most.
  double jump(int frame) const;
  bool has_jumped() const { return has_jumped_ || !jumps_.empty(); }  ///< any frame

  /// The rig of the current frame with its right principal point corrected by the offset, without undistortion tables.
  const StereoRig& rig() const { return rig_; }
  /// That of an earlier frame.
  StereoRig rig_at(int frame) const { return with_disparity_offset(calibration_, value_ - jump(frame)); }
  double value() const { return value_; }  ///< added to disparities [px]
  /// The rig's error beside the offset. See StereoRig.
  void set_right_error(const RightCameraError& error) {
    calibration_.right_error = error;
    rig_ = rig_at(frame_);
  }
  RightCamera& right_camera() { return right_camera_; }
  /// Lets the offset be learned anew from its value.
  void widen(double variance) { variance_ = std::max(variance_, variance); }
  double variance() const {
    return variance_;
  }  ///< predicted for the next frame [px^2]; 0: disparities are assumed exact

 private:
  StereoRig calibration_;  ///< without undistortion tables
  StereoRig rig_;
  double drift_;
  double value_, variance_;
  RightCamera right_camera_;
  int frame_ = 0;                ///< the current one
  std::map<int, double> jumps_;  ///< of the frames that have jumped
  bool has_jumped_ = false;      ///< before the current frame
};

}  // namespace quadedge::odometry
