/// \file forms.cpp  Tries all forms in order; refuses lenses and relative poses that no rig has.
#include "data/calibrations/forms.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <set>

#include "common/printed.hpp"
#include "data/atomic_file.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "data/toml_file.hpp"
#include "geometry/calibration.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace data {
namespace {

/// For files of one camera that no form combines: what is missing is the transform.
[[noreturn]] StatedCalibration refuse_single_cameras(const std::vector<CalibrationText>& texts) {
  fail(
      texts[0].file + (texts.size() > 1 ? ", " + texts[1].file : ""),
      "the intrinsics of single cameras, without the transform between them",
      "a file that holds it as well: VINS-Fusion's configuration (body_T_cam0, body_T_cam1, cam0_calib, cam1_calib), a "
      "Kalibr chain (T_cn_cnm1), or OpenCV's stereo calibration (R, T)");
}

bool is_single_camera(const CalibrationText& text) {
  return text.has("model_type") || text.has("projection_parameters") || text.has("camera_matrix") ||
         kStereoDso.recognise(text);
}

constexpr CalibrationForm kSingleCameras{"single", "", false, is_single_camera, refuse_single_cameras};

/// All forms, in the order in which they are tried.
const std::vector<CalibrationForm>& calibration_forms() {
  static const std::vector<CalibrationForm> forms = {
      kEurocSensors, kCameraInfos, kKalibrChain, kOrbSlam, kStellaVslam,  kVinsFusion,
      kBasalt,       kMrcal,       kEdex,        kDepthai, kZed,          kRealsense,
      kKittiCameras, kMatlab,      kStereoDso,   kNative,  kOpencvStereo, kSingleCameras};
  return forms;
}

/// The cameras of one file: of several documents, as `ros2 topic echo` appends messages, those that differ.
std::vector<CalibrationText> cameras_of(const CalibrationText& text, const CalibrationForm& form) {
  std::vector<CalibrationText> cameras;
  std::set<std::string> seen;
  for (YAML::Node node : YAML::LoadAll(text.text)) {
    if (!node.IsMap()) continue;
    node.remove("header");
    CalibrationText camera{text.file, text.text, YamlMap(node, text.file, form.contents)};
    if (form.recognise(camera) && seen.insert(YAML::Dump(node)).second) cameras.push_back(std::move(camera));
  }
  return cameras;
}

/// OpenCV's XML as YAML.
YAML::Node node_of(const cv::FileNode& from) {
  YAML::Node node;
  if (from.isMap()) {
    for (const std::string& key : from.keys()) {
      if (node[key].IsDefined()) throw cv::Exception(0, "a second entry " + key, "", "", 0);
      node[key] = node_of(from[key]);
    }
  } else if (from.isSeq()) {
    for (const cv::FileNode& item : from) node.push_back(node_of(item));
  } else {
    node = from.isString() ? from.string() : format_exact(from.real());
  }
  return node;
}

std::string metres(const Eigen::Vector3d& position) {
  return printed("(%g, %g, %g) m", position.x(), position.y(), position.z());
}

std::string first_entries(const CalibrationText& text) {
  constexpr std::size_t kShown = 6;
  if (!text.map) {
    const auto lines = data_lines(text.file);
    return lines.empty() ? "nothing" : "a text that begins with " + in_quotes(lines[0].text);
  }
  const auto keys = text.map->keys();
  std::string list;
  for (std::size_t i = 0; i < std::min(keys.size(), kShown); ++i) list += (i ? ", " : "") + keys[i];
  return "the entries " + in_quotes(list) + (keys.size() > kShown ? " and others" : "");
}

std::string all_contents() {
  std::string list;
  for (const CalibrationForm& form : calibration_forms()) {
    if (form.contents[0] == '\0') continue;
    list += (list.empty() ? "one of these formats: " : "; ") + std::string(form.contents) +
            (form.has_two_files ? " (two files)" : "");
  }
  return list;
}

/// Reads a text and its entries, if it has any. \throws DataError as read_text()
CalibrationText read_calibration_text(const std::string& file) {
  CalibrationText text{file, read_text(file), {}};
  if (kMrcal.recognise(text)) text.text = yaml_of_python(text.text);
  const bool is_ini = kZed.recognise(text);
  const bool is_plain = kRealsense.recognise(text) || kMatlab.recognise(text) || kStereoDso.recognise(text);
  const std::size_t first = text.text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text.text[first] == '<') {
    try {
      cv::FileStorage storage(text.text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
      if (!storage.isOpened() || !storage.root().isMap()) return text;
      text.map.emplace(node_of(storage.root()), file, "OpenCV's stereo calibration");
    } catch (const cv::Exception& problem) {
      fail(file, "text that cv::FileStorage does not read (" + problem.err + ")", "OpenCV's stereo calibration");
    }
  } else if (!is_plain && (first == std::string::npos || text.text[first] != '[' || is_ini || kEdex.recognise(text))) {
    const YAML::Node node = parse_yaml(is_ini ? yaml_of_ini(text.text) : text.text, file, all_contents());
    const YAML::Node entries = node.IsSequence() && node.size() > 0 ? node[0] : node;
    if (!entries.IsMap()) fail(file, "no entries", all_contents());
    text.map.emplace(entries, file, all_contents());
  }
  return text;
}

[[noreturn]] void fail_unknown(const std::vector<CalibrationText>& texts) {
  std::string found = first_entries(texts[0]);
  if (texts.size() > 1) found += ", and in " + texts[1].file + " " + first_entries(texts[1]);
  fail(texts[0].file, found, all_contents());
}

/// \throws DataError for a relative pose that a stereo camera cannot have: views in different directions, a baseline of
/// zero or tens of metres, the right camera on the left.
void check_relative_pose(const StereoCalibration& calibration) {
  const double angle = std::acos(std::clamp(calibration.right_from_left.linear()(2, 2), -1.0, 1.0));
  constexpr double kWidest = 60 * kDegree;
  if (angle > kWidest)
    fail(calibration.files, "optical axes " + printed("%.0f", angle / kDegree) + " degrees apart",
         "the two cameras of a stereo pair, which look in the same direction");
  const Eigen::Vector3d right = calibration.right_from_left.inverse().translation();  // in the left camera frame
  const std::string found = "a right camera at " + metres(right) + " from the left one";
  constexpr double kShortest = 1e-6, kLongest = 30;  // m
  if (!right.allFinite() || !(right.norm() > kShortest))
    fail(calibration.files, found, "a baseline above zero: were the cameras calibrated one by one?");
  if (right.norm() > kLongest) fail(calibration.files, found, "metres: millimetres, perhaps");
  if (right.x() < 0 && -right.x() >= std::abs(right.y())) {
    fail(calibration.files, found + ", which is on its left",
         "x above zero: the cameras are exchanged or a transform is inverted");
  }
}

/// \throws DataError that names the entries, for values that no camera has or that are invalid for the lens model.
void check_lens(const StatedLens& stated) {
  const Lens& lens = stated.lens;
  if (const auto complaint = complaint_about(lens.camera))
    fail(stated.file + " (" + stated.camera_entry + ")", complaint->found, complaint->expected);
  const auto& k = lens.parameters;
  const std::string where = stated.file + " (" + stated.coefficients_entry + ")";
  const auto require = [&](bool good, const std::string& found, const std::string& expected) {
    if (!good) fail(where, found, expected);
  };
  const auto count_is = [&](std::initializer_list<std::size_t> allowed, const char* expected) {
    require(std::find(allowed.begin(), allowed.end(), k.size()) != allowed.end(),
            std::to_string(k.size()) + " numbers for the lens model " + to_string(lens.model), expected);
  };
  for (const double value : k)
    require(std::abs(value) <= kLargestCoefficient, "a coefficient " + format_exact(value), "numbers up to 1e5");
  switch (lens.model) {
    case LensModel::radial_tangential:
      count_is({0, 4, 5, 8, 12, 14}, "0, 4, 5, 8, 12 or 14 coefficients");
      if (k.size() == 14) {
        require(std::abs(k[12]) < 1 && std::abs(k[13]) < 1,
                "a sensor tilted by " + format_exact(k[12]) + " and " + format_exact(k[13]), "radians, below 1");
      }
      break;
    case LensModel::equidistant: count_is({4}, "4 coefficients"); break;
    case LensModel::field_of_view:
      count_is({1}, "the one parameter w");
      require(k[0] > 0 && k[0] < kPi, "w = " + format_exact(k[0]), "radians, above 0 and below pi");
      break;
    case LensModel::double_sphere:
      count_is({2}, "xi and alpha");
      require(k[0] > -1 && k[1] >= 0 && k[1] <= 1, "xi = " + format_exact(k[0]) + ", alpha = " + format_exact(k[1]),
              "xi above -1 and alpha from 0 to 1");
      break;
    case LensModel::extended_unified:
      count_is({2}, "alpha and beta");
      require(k[0] >= 0 && k[0] <= 1 && k[1] > 0, "alpha = " + format_exact(k[0]) + ", beta = " + format_exact(k[1]),
              "alpha from 0 to 1 and beta above 0");
      break;
    case LensModel::omnidirectional:
      count_is({1, 5, 6, 9, 13, 15}, "xi and 0, 4, 5, 8, 12 or 14 coefficients");
      require(k[0] >= 0, "xi = " + format_exact(k[0]), "0 or more");
      break;
  }
}

}  // namespace

StereoCalibration judged(const StatedCalibration& stated, const std::string& format, const std::string& files) {
  check_lens(stated.left);
  check_lens(stated.right);
  StereoCalibration calibration;
  calibration.left = stated.left.lens;
  calibration.right = stated.right.lens;
  calibration.right_from_left = stated.right_from_left;
  calibration.right_from_left.linear() = nearest_rotation(stated.right_from_left.linear(), files);
  calibration.body_from_left = stated.body_from_left;
  calibration.format = format;
  calibration.files = files;
  check_relative_pose(calibration);
  calibration.right_from_left = rounded_transform(calibration.right_from_left);
  for (const StatedCalibration& other : stated.other_sizes)
    calibration.other_sizes.push_back(judged(other, format, files));
  for (const StatedCalibration& other : stated.of_rectified)
    calibration.of_rectified.push_back(judged(other, format, files));
  return calibration;
}

StatedLens::StatedLens(std::string in_file, std::string camera, std::string coefficients, const std::vector<double>& k,
                       ImageSize size)
    : file(std::move(in_file)), camera_entry(std::move(camera)), coefficients_entry(std::move(coefficients)) {
  set_size(lens.camera, size);
  if (k.empty()) return;
  lens.camera.fx = k[0];
  lens.camera.fy = k[1];
  lens.camera.cx = k[2];
  lens.camera.cy = k[3];
}

std::vector<double> row_major(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  return values;
}

std::string matrix_lines(const std::string& name, std::size_t rows, const std::vector<double>& values,
                         const std::string& type) {
  return name + ":" + (type.empty() ? "" : " " + type) + "\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(values.size() / rows) + (type.empty() ? "" : "\n   dt: d") +
         "\n   data: " + toml_text(values) + "\n";
}

void refuse_lens(const std::string& form, const Lens& lens, Side side, const std::string& expected) {
  throw UsageError("format " + form + ": the " + (side == Side::left ? "left" : "right") + " lens is " +
                   to_string(lens.model) + " with " + counted(lens.parameters.size(), "parameter") + ", expected " +
                   expected);
}

Eigen::Matrix3d rotation_of_vector(const Eigen::Vector3d& vector, const std::string& where) {
  const double angle = vector.norm();
  if (!(angle <= 1.001 * kPi))
    fail(where, "a rotation by " + format_exact(angle) + " rad", "a vector of at most pi: degrees, perhaps");
  return rotation_by(vector);
}

void set_intrinsics(const YamlMap& camera, const std::string& key, PinholeCamera& result, double last) {
  const auto k = camera.matrix(key, 3, 3);
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || (k[8] != 1 && k[8] != last))
    camera.complain(key, "a matrix with skew or another last row", "fx 0 cx 0 fy cy 0 0 1");
  result.fx = k[0];
  result.fy = k[4];
  result.cx = k[2];
  result.cy = k[5];
}

std::vector<double> coefficients_of(const YamlMap& camera, const std::string& key) {
  const YamlMatrix values = camera.matrix(key);
  if (values.rows > 1 && values.columns > 1)
    camera.complain(key, "a matrix of several rows and columns", "one row of coefficients");
  return values.values;
}

StatedLens read_matrix_lens(const YamlMap& camera, const std::string& matrix, const std::string& coefficients,
                            ImageSize size, double last) {
  StatedLens stated(camera.file(), camera.name(matrix), camera.name(coefficients), {}, size);
  set_intrinsics(camera, matrix, stated.lens.camera, last);
  stated.lens.parameters = coefficients_of(camera, coefficients);
  return stated;
}

Eigen::Isometry3d right_from_left_of(const Rectification& left, const Rectification& right) {
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d right_from_rectified = right.rectified_from_camera.transpose();
  right_from_left.linear() = right_from_rectified * left.rectified_from_camera;
  right_from_left.translation() =
      right_from_rectified * (right.rectified_from_reference - left.rectified_from_reference);
  return right_from_left;
}

Eigen::Vector3d projection_offset(const YamlMap& camera, const std::string& key) {
  const auto p = camera.matrix(key, 3, 4);
  if (!(p[0] > 0 && p[5] > 0)) camera.complain(key, "no focal length", "fx' and fy' above zero");
  if (p[1] != 0 || p[4] != 0) camera.complain(key, "skew", "0 beside fx' and fy', as rectified images have it");
  if (p[8] != 0 || p[9] != 0 || p[10] != 1)
    camera.complain(key, "a last row other than 0 0 1", "that of a rectified camera");
  return PinholeCamera{p[0], p[5], p[2], p[6], 0, 0}.matrix().inverse() * Eigen::Vector3d(p[3], p[7], p[11]);
}

StatedCalibration rectified_cameras(const YamlMap& left, const std::string& left_key, ImageSize left_size,
                                    const YamlMap& right, const std::string& right_key, ImageSize right_size) {
  const auto lens = [](const YamlMap& camera, const std::string& key, ImageSize size) {
    const auto p = camera.matrix(key, 3, 4);
    return StatedLens(camera.file(), key, key, {p[0], p[5], p[2], p[6]}, size);
  };
  StatedCalibration rectified;
  rectified.left = lens(left, left_key, left_size);
  rectified.right = lens(right, right_key, right_size);
  rectified.right_from_left.translation() = projection_offset(right, right_key) - projection_offset(left, left_key);
  return rectified;
}

void set_image_sizes(StereoCalibration& calibration, ImageSize left, ImageSize right, const std::string& images) {
  if (left == right && size_of(calibration.left.camera) != left) {
    for (StereoCalibration& other : calibration.other_sizes) {
      if (size_of(other.left.camera) != left || size_of(other.right.camera) != right) continue;
      StereoCalibration chosen = std::move(other);
      calibration = std::move(chosen);
      return;
    }
  }
  const auto set = [&](PinholeCamera& camera, ImageSize size, const char* which) {
    if (camera.width == 0) set_size(camera, size);
    if (size_of(camera) == size) return;
    std::string expected = to_string(size_of(camera));
    for (const StereoCalibration& other : calibration.other_sizes)
      expected += " or " + to_string(size_of(other.left.camera));
    fail(images, std::string(which) + " images of " + to_string(size) + " pixels",
         expected + ", as " + calibration.files + " says");
  };
  set(calibration.left.camera, left, "left");
  set(calibration.right.camera, right, "right");
  for (StereoCalibration& rectified : calibration.of_rectified) {
    if (rectified.left.camera.width == 0) set(rectified.left.camera, left, "left");
    if (rectified.right.camera.width == 0) set(rectified.right.camera, right, "right");
  }
}

}  // namespace data

StereoCalibration read_calibration(const std::string& files, bool rectified) {
  std::vector<data::CalibrationText> texts;
  for (const std::string& file : data::file_list(files)) texts.push_back(data::read_calibration_text(file));
  for (const data::CalibrationForm& form : data::calibration_forms()) {
    if (!std::all_of(texts.begin(), texts.end(), form.recognise)) continue;
    if (form.has_two_files && texts.size() < 2) {
      auto both = data::cameras_of(texts[0], form);
      if (both.size() != 2) {
        data::fail(texts[0].file, "the calibration of one camera (" + std::string(form.contents) + ")",
                   "those of both cameras: LEFT,RIGHT");
      }
      texts = std::move(both);
    }
    for (data::CalibrationText& text : texts)
      if (text.map) text.map = text.map->as(form.contents);
    const data::StatedCalibration stated = form.read(texts);
    if (rectified && stated.of_rectified.empty())
      data::fail(files, "no projection matrices of rectified images", "P as in ROS's camera_info, or no --rectified");
    return data::judged(rectified ? stated.of_rectified.front() : stated, form.name, files);
  }
  data::fail_unknown(texts);
}

std::vector<std::string> calibration_formats() {
  std::vector<std::string> names;
  for (const data::CalibrationForm& form : data::calibration_forms())
    if (form.write != nullptr) names.emplace_back(form.name);
  return names;
}

void write_calibration(const std::string& files, const StereoCalibration& calibration, const std::string& format) {
  std::string expected;
  for (const data::CalibrationForm& form : data::calibration_forms()) {
    if (form.write == nullptr) continue;
    expected += (expected.empty() ? "" : ", ") + std::string(form.name);
    if (form.name != format) continue;
    const std::vector<std::string> texts = form.write(calibration),
                                   names = form.has_two_files ? data::file_list(files) : std::vector{files};
    if (names.size() != texts.size()) throw UsageError(files + ": expected two files for " + format + ": LEFT,RIGHT");
    for (std::size_t i = 0; i < names.size(); ++i) data::write_atomically(names[i], texts[i]);
    return;
  }
  throw UsageError("calibration format " + data::in_quotes(format) + ": expected one of " + expected);
}

}  // namespace quadedge
