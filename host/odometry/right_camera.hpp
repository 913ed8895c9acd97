#pragma once
/// \file right_camera.hpp  Whether the columns confirm what the rows say of the right camera (doc/method.md section 7).

#include "quadedge/camera.hpp"
#include "rig/row_model.hpp"

namespace quadedge::odometry {

/// Judges the error of the right camera that would make its rows what they are. An error of the calibration moves
/// points along the lines, too, so that the motion found with it explains the edges better. Rows of another cause, as
/// those of KITTI, are not believed; nothing that they say later is, until they are learned anew.
class RightCamera {
 public:
  /// Begins a frame. Of a rig whose epipolar lines are far from rows, nothing is claimed. \param rows what the rows of
  /// the earlier frames say
  void claim(const rig::RowModel& rows, const StereoRig& rig);
  /// Whether motions are to be compared.
  bool is_open() const { return is_open_; }
  /// What is to be compared with error().
  const RightCameraError& claimed() const { return claimed_; }
  /// Takes a frame into account. \param gain logarithm of the likelihood of its edges with claimed(), less that with
  /// error() \returns whether that is confirmed now
  bool weigh(double gain);
  /// What is confirmed, or zero.
  const RightCameraError& error() const { return error_; }

 private:
  RightCameraError claimed_, error_;
  int terms_ = 0;      ///< of claimed_ that the frames compared had
  int confirmed_ = 0;  ///< terms of error_
  double evidence_ = 0;
  int compared_ = 0;   ///< frames
  double frames_ = 0;  ///< on which the rows rest
  bool is_open_ = false, is_refuted_ = false;
};

}  // namespace quadedge::odometry
