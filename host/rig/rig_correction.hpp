#pragma once
/// \file rig_correction.hpp  What the rows of a recording tell of the right camera, for a corrected calibration.

#include <string>

#include "quadedge/calibration.hpp"
#include "quadedge/camera.hpp"
#include "rig/row_model.hpp"

namespace quadedge::rig {

/// How the right camera differs from the calibration. A turn about the third axis moves points along their lines, which
/// rows do not show; a principal point that is off across the lines looks like a pitch.
struct RigCorrection {
  enum Part { pitch, roll, focal, kParts };
  /// Turn of the camera about the baseline and about its optical axis [rad], and change of its focal length across the
  /// lines as a part of it.
  Eigen::Vector3d parts = Eigen::Vector3d::Zero(), sigmas = Eigen::Vector3d::Zero();

  /// Whether a part exceeds kTermSigmas standard deviations; the others are not corrected.
  bool is_certain(int part) const;
  /// The calibration with what is certain.
  StereoCalibration applied(StereoCalibration calibration) const;
  /// For the user, in one sentence.
  std::string text() const;
};

/// \param rows those of a recording with the rig, not without frames
RigCorrection correction_of(const StereoRig& rig, const RowModel& rows);

}  // namespace quadedge::rig
