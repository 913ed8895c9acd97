/// \file euroc.cpp  EuRoC: one sensor.yaml per camera; T_BS maps points from the camera frame to the body
/// frame.

#include "data/calibrations/forms.hpp"

namespace quadedge::data {

StereoCalibration read_euroc_calibration(const std::string& left, const std::string& right) {
  constexpr const char* kSensorFile = "the sensor.yaml of a EuRoC camera";
  return judged(read_euroc_sensors({left, kSensorFile}, {right, kSensorFile}), "euroc", left + "," + right);
}

StatedCalibration read_euroc_sensors(const YamlMap& left, const YamlMap& right) {
  StatedCalibration calibration;
  calibration.left = read_named_lens(left, "distortion_coefficients");
  calibration.right = read_named_lens(right, "distortion_coefficients");
  const Eigen::Isometry3d body_from_left = left.map("T_BS").transform("data"),
                          body_from_right = right.map("T_BS").transform("data");
  calibration.right_from_left = body_from_right.inverse() * body_from_left;
  calibration.body_from_left = body_from_left;
  return calibration;
}

}  // namespace quadedge::data
