#include "odometry/right_camera.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::odometry {
namespace {

/// An error that moves no corner of the image by so much against its middle is left alone: rows of two recordings with
/// one rig differ by 0.2 px [px].
constexpr double kLeast = 0.2;
/// Edges of one curve, and those of a view, share their errors: so many count as one.
constexpr double kSharedErrors = 10;
constexpr double kMostTilt = 0.2;    ///< of the baseline against rows, as a tangent
constexpr double kDecisive = 20;     ///< logarithm of a ratio of likelihoods
constexpr double kMostOfFrame = 15;  ///< the same, of a single frame
constexpr int kMostCompared = 10;    ///< frames

enum Term { yaw = 1, pitch = 2, lens = 4 };

int terms_of(const RightCameraError& error) {
  return (error.yaw != 0 ? yaw : 0) + (error.pitch != 0 ? pitch : 0) +
         (error.radial_3 != 0 || error.radial_5 != 0 ? lens : 0);
}

RightCameraError only(const RightCameraError& error, int terms) {
  return {(terms & yaw) != 0 ? error.yaw : 0, (terms & pitch) != 0 ? error.pitch : 0,
          (terms & lens) != 0 ? error.radial_3 : 0, (terms & lens) != 0 ? error.radial_5 : 0};
}

double largest(const RightCameraError& error, const PinholeCamera& right) {
  double result = 0;
  for (const int x : {0, right.width - 1})
    for (const int y : {0, right.height - 1}) result = std::max(result, std::abs(error.column(right, x, y)));
  return result;
}

}  // namespace

void RightCamera::claim(const rig::RowModel& rows, const StereoRig& rig) {
  const Eigen::Vector3d baseline = rig.right_from_left.translation();
  if (!(-baseline.x() * kMostTilt > baseline.tail<2>().norm())) return;
  if (rows.sums().frames < frames_) *this = RightCamera();  // they are learned anew
  frames_ = rows.sums().frames;
  const RightCameraError by_rows = rows.camera_error();
  claimed_ = by_rows;
  const int terms = terms_of(by_rows);
  confirmed_ = (confirmed_ | terms_of(rows.known_camera_error())) & terms;
  error_ = only(by_rows, confirmed_);
  if (terms != terms_) evidence_ = 0;
  terms_ = terms;
  const RightCameraError change = {by_rows.yaw - error_.yaw, by_rows.pitch - error_.pitch,
                                   by_rows.radial_3 - error_.radial_3, by_rows.radial_5 - error_.radial_5};
  is_open_ = !is_refuted_ && compared_ < kMostCompared && largest(change, rig.right) > kLeast;
}

bool RightCamera::weigh(double gain) {
  evidence_ += std::clamp(gain / kSharedErrors, -kMostOfFrame, kMostOfFrame);
  ++compared_;
  is_open_ = false;
  if (evidence_ <= -kDecisive) is_refuted_ = true;
  if (evidence_ < kDecisive) return false;
  confirmed_ = terms_;
  error_ = claimed_;
  return true;
}

}  // namespace quadedge::odometry
