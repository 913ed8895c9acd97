#pragma once
/// \file calibration_formats.hpp  Common parts of the readers of calibration files: calibration_euroc,
/// calibration_kalibr, calibration_opencv, calibration_ros, calibration_native.

#include <string>
#include <vector>

#include "data/image_file.hpp"
#include "data/yaml_file.hpp"
#include "quadedge/calibration.hpp"

namespace quadedge::data {

/// Reads the sensor.yaml files of both cameras of a EuRoC recording.
StereoCalibration read_euroc_calibration(const std::string& left, const std::string& right);

/// Reads parsed sensor.yaml files of both cameras.
StereoCalibration read_euroc_sensors(const YamlMap& left, const YamlMap& right);

/// Reads Kalibr's camera chain.
StereoCalibration read_kalibr_chain(const YamlMap& chain);

/// Reads ROS camera_info files of both cameras.
StereoCalibration read_ros_camera_infos(const YamlMap& left, const YamlMap& right);

/// Reads one or two of OpenCV's stereo files.
StereoCalibration read_opencv_calibration(const std::vector<std::string>& files);

/// Reads the format of write_calibration().
StereoCalibration read_native_calibration(const YamlMap& file);

/// Completes the result of a reader with format and file names; checks and rounds the rig (see StereoCalibration).
/// \throws DataError for a baseline that a stereo camera cannot have
StereoCalibration finished(StereoCalibration calibration, const std::string& format, const std::string& files);

/// Reads a lens in Kalibr's and EuRoC's notation: entries camera_model, distortion_model, intrinsics, `coefficients`
/// (key of the distortion coefficients) and resolution. \throws DataError
Lens read_named_lens(const YamlMap& camera, const std::string& coefficients);

/// Rotation of a rotation vector (axis times radians). \throws DataError that names `where`, for more than a half turn,
/// which suggests degrees
Eigen::Matrix3d rotation_of_vector(const Eigen::Vector3d& vector, const std::string& where);

/// \throws DataError that names the file and one of the keys, for values that no camera has or that are invalid for the
/// lens model.
void check_lens(const Lens& lens, const std::string& file, const std::string& camera_key,
                const std::string& coefficients_key);

/// Sets the sizes of the recorded images if the calibration does not contain them. \throws DataError that names
/// `images`, if the calibration contains other sizes
void set_image_sizes(StereoCalibration& calibration, ImageSize left, ImageSize right, const std::string& images);

}  // namespace quadedge::data
