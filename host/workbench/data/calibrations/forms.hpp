#pragma once
/// \file forms.hpp  The forms of calibration files: how each is recognised and read, how some are written, and what all
/// of them are judged by. Every form has a file of its name beside this one; the list in forms.cpp has their order.

#include <optional>
#include <string>
#include <vector>

#include "data/image_file.hpp"
#include "data/yaml_file.hpp"
#include "quadedge/calibration.hpp"

namespace quadedge::data {

/// The content of a calibration file.
struct CalibrationText {
  std::string file, text;
  std::optional<YamlMap> map;  ///< the entries of YAML, JSON, OpenCV's XML, or lines of NAME: NUMBERS

  bool has(const char* key) const { return map && map->has(key); }
  const YamlMap& entries() const { return *map; }  ///< for forms that are recognised by an entry
};

/// A lens as a form states it, with the names of its entries for messages.
struct StatedLens {
  StatedLens() = default;
  /// `k`: fx, fy, cx, cy; none: to be set later.
  StatedLens(std::string in_file, std::string camera, std::string coefficients, const std::vector<double>& k = {},
             ImageSize size = {});

  Lens lens;
  std::string file, camera_entry, coefficients_entry;
};

/// What a form states: lengths in metres, angles in radians, the left camera first.
struct StatedCalibration {
  StatedLens left, right;
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> body_from_left;
  std::vector<StatedCalibration> other_sizes;   ///< the same cameras at other image sizes
  std::vector<StatedCalibration> of_rectified;  ///< the cameras of rectified images, if stated: none or one
};

/// A form of calibration files.
struct CalibrationForm {
  const char* name;      ///< StereoCalibration::format
  const char* contents;  ///< for messages and the page: "a Kalibr camera chain (cam0, cam1)"
  bool has_two_files;    ///< one file for each camera
  bool (*recognise)(const CalibrationText& text);
  /// \throws DataError
  StatedCalibration (*read)(const std::vector<CalibrationText>& texts);
  /// The texts of the files; null: the form is only read. \throws UsageError for what it cannot hold
  std::vector<std::string> (*write)(const StereoCalibration& calibration) = nullptr;
};

extern const CalibrationForm kEurocSensors, kCameraInfos, kKalibrChain, kOrbSlam, kStellaVslam, kVinsFusion, kBasalt,
    kMrcal, kEdex, kDepthai, kZed, kRealsense, kKittiCameras, kMatlab, kStereoDso, kNative, kOpencvStereo;

/// Cameras `left` and `right` of KITTI's calib_cam_to_cam.txt or KITTI-360's perspective.txt: "00" and "01" are grey,
/// "02" and "03" colour. Rectified images first; the images as recorded have another size.
StatedCalibration read_kitti_cameras(const YamlMap& cameras, const std::string& left, const std::string& right);

/// A Python literal as YAML: without comments, tuples as lists, strings of bytes as strings.
std::string yaml_of_python(const std::string& python);
/// An INI file as YAML, in upper case: a map per section.
std::string yaml_of_ini(const std::string& ini);

/// Row-major numbers as the YAML of ROS; `type` "!!opencv-matrix": as that of OpenCV.
std::string matrix_lines(const std::string& name, std::size_t rows, const std::vector<double>& values,
                         const std::string& type = "");
std::vector<double> row_major(const Eigen::MatrixXd& matrix);

/// \throws UsageError that names the side and says which lenses the form can hold
[[noreturn]] void refuse_lens(const std::string& form, const Lens& lens, Side side, const std::string& expected);

/// Judges what a form states: numbers of the lenses, baseline, units; rounds the transform (see StereoCalibration).
/// \throws DataError
StereoCalibration judged(const StatedCalibration& stated, const std::string& format, const std::string& files);

/// The sensor.yaml files of both cameras of a EuRoC recording. \throws DataError
StereoCalibration read_euroc_calibration(const std::string& left, const std::string& right);

/// Reads a lens in Kalibr's and EuRoC's notation: entries camera_model, distortion_model, intrinsics, `coefficients`
/// (key of the distortion coefficients) and resolution. \throws DataError
StatedLens read_named_lens(const YamlMap& camera, const std::string& coefficients);

/// The model that a camera_info message or OpenCV's results call `word`. \throws DataError that names `key`
LensModel model_of_word(const YamlMap& camera, const std::string& key, const std::string& word);

/// Rows of a 3 x 3 matrix. \throws DataError for numbers that are not those of fx 0 cx 0 fy cy 0 0 1, or `last`
void set_intrinsics(const YamlMap& camera, const std::string& key, PinholeCamera& result, double last = 1);

/// Coefficients in a row or a column, or none. \throws DataError for a matrix of both
std::vector<double> coefficients_of(const YamlMap& camera, const std::string& key);

/// A camera by its matrix and its coefficients in OpenCV's order, of which there may be none.
StatedLens read_matrix_lens(const YamlMap& camera, const std::string& matrix, const std::string& coefficients,
                            ImageSize size, double last = 1);

/// What a rectifying calibration states of a camera: the rotation of its images, and the position of the rectified
/// camera in units of the baseline's.
struct Rectification {
  Eigen::Matrix3d rectified_from_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d rectified_from_reference = Eigen::Vector3d::Zero();  ///< m, the fourth column of K [I | t]
};

/// The transform between two cameras whose rectified images share one orientation.
Eigen::Isometry3d right_from_left_of(const Rectification& left, const Rectification& right);

/// The fourth column of a projection matrix K [I | t] as t [m]. \throws DataError for another matrix
Eigen::Vector3d projection_offset(const YamlMap& camera, const std::string& key);

/// The cameras of rectified images by their projection matrices. \throws DataError as projection_offset()
StatedCalibration rectified_cameras(const YamlMap& left, const std::string& left_key, ImageSize left_size,
                                    const YamlMap& right, const std::string& right_key, ImageSize right_size);

/// Rotation of a rotation vector (axis times radians). \throws DataError that names `where`, for more than a half turn,
/// which suggests degrees
Eigen::Matrix3d rotation_of_vector(const Eigen::Vector3d& vector, const std::string& where);

/// Sets the sizes of the recorded images if the calibration does not contain them, or takes its cameras of that size
/// where it holds several. \throws DataError that names `images`, if the calibration contains other sizes
void set_image_sizes(StereoCalibration& calibration, ImageSize left, ImageSize right, const std::string& images);

}  // namespace quadedge::data
