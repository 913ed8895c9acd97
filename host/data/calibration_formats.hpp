#pragma once
/// \file calibration_formats.hpp  What the readers of calibration files share. One reader per file: calibration_euroc,
/// calibration_kalibr, calibration_opencv, calibration_ros, calibration_native.

#include <string>
#include <vector>

#include "data/image_file.hpp"
#include "data/yaml_file.hpp"
#include "quadedge/calibration.hpp"

namespace quadedge::data {

/// Reads both sensor.yaml of a EuRoC recording.
StereoCalibration read_euroc_calibration(const std::string& left, const std::string& right);

/// sensor.yaml of both cameras.
StereoCalibration read_euroc_sensors(const YamlMap& left, const YamlMap& right);

/// Kalibr's camera chain.
StereoCalibration read_kalibr_chain(const YamlMap& chain);

/// ROS camera_info of both cameras.
StereoCalibration read_ros_camera_infos(const YamlMap& left, const YamlMap& right);

/// OpenCV's stereo files, one or two.
StereoCalibration read_opencv_calibration(const std::vector<std::string>& files);

/// What write_calibration() writes.
StereoCalibration read_native_calibration(const YamlMap& file);

/// What one of the readers found, with its names; the rig is checked and rounded (see StereoCalibration). \throws
/// DataError for a baseline that no stereo camera has.
StereoCalibration finished(StereoCalibration calibration, const std::string& format, const std::string& files);

/// A lens told by Kalibr's and EuRoC's words: entries camera_model, distortion_model, intrinsics, `coefficients` (the
/// key of the distortion's coefficients) and resolution. \throws DataError
Lens read_worded_lens(const YamlMap& camera, const std::string& coefficients);

/// The rotation by a vector (axis times radians). \throws DataError, which names `where`, for more than half a turn:
/// degrees, most likely.
Eigen::Matrix3d rotation_of_vector(const Eigen::Vector3d& vector, const std::string& where);

/// \throws DataError, which names the lens by `where` ("FILE (cam0)"), for numbers that are no lens of its model.
void check_lens(const Lens& lens, const std::string& where);

/// Fills in the sizes of the recorded images where the calibration leaves them open. \throws DataError, which names
/// `images`, where it says otherwise.
void set_image_sizes(StereoCalibration& calibration, ImageSize left, ImageSize right, const std::string& images);

}  // namespace quadedge::data
