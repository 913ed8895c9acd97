#pragma once
/// \file rig_change.hpp  What it means to measure with one calibration where another one is true.

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/drive_calibration.hpp"

namespace quadedge::rig {

/// Error of the depth that the given calibration measures at a true depth [m], as a part of it: median over the image
/// of its absolute value.
double depth_error(const StereoCalibration& given, const StereoCalibration& learned, double depth);

/// Distance of a point from its epipolar lines, by both images (Sampson) [px of the left camera].
std::optional<double> sampson_distance(const StereoCalibration& calibration, const Eigen::Vector2d& left,
                                       const Eigen::Vector2d& right);

/// All of it. `points`: recorded pixels of both cameras that show the same [px].
CalibrationChange change_of(const StereoCalibration& given, const StereoCalibration& learned,
                            const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& points);

}  // namespace quadedge::rig
