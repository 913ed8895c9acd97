#pragma once
/// \file rig_change.hpp  What it means to measure with one calibration where another one is true.

#include "quadedge/calibration.hpp"
#include "quadedge/drive_calibration.hpp"

namespace quadedge::rig {

/// Error of the depth that the given calibration measures at a true depth [m], as a part of it: median over the image
/// of its absolute value.
double depth_error(const StereoCalibration& given, const StereoCalibration& learned, double depth);

/// All of it.
CalibrationChange change_of(const StereoCalibration& given, const StereoCalibration& learned);

}  // namespace quadedge::rig
