#pragma once
/// \file calibration_report.hpp  A learned calibration for people and programs: a table, JSON.

#include <string>

#include "output/json_values.hpp"
#include "quadedge/drive_calibration.hpp"

namespace quadedge::report {

/// Judgement, numbers with their deviations, what they change, covariance, as a file with its origin.
std::string calibration_json(const DriveCalibration& result, const std::string& command);

/// A line per number: change, deviation and prior; then what they change: depths, rotation, distances from the epipolar
/// lines.
std::string calibration_table(const DriveCalibration& result);

}  // namespace quadedge::report
