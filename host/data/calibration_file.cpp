/// \file calibration_file.cpp  Recognises the format of a calibration by its content, reads it and checks the resulting
/// rig.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/camera_bounds.hpp"
#include "common/rounded_transform.hpp"
#include "data/calibration_formats.hpp"
#include "data/file_list.hpp"
#include "data/text.hpp"
#include "quadedge/pi.hpp"

namespace quadedge {
namespace data {
namespace {

constexpr const char* kFormats =
    "a Kalibr camera chain (cam0, cam1), an OpenCV stereo file (M1 D1 M2 D2 R T), two ROS camera_info files, two EuRoC "
    "sensor.yaml, or a file written by `quadedge check --write-calibration` (left_model ...)";

std::string first_keys(const YamlMap& map) {
  constexpr std::size_t kShown = 6;
  const auto keys = map.keys();
  std::string list;
  for (std::size_t i = 0; i < std::min(keys.size(), kShown); ++i) list += (i ? ", " : "") + keys[i];
  return "the entries " + in_quotes(list) + (keys.size() > kShown ? " and others" : "");
}

const YamlMap& second_of(const std::vector<YamlMap>& maps, const std::string& format) {
  if (maps.size() == 2) return maps[1];
  fail(maps[0].file(), "the " + format + " of one camera", "those of both cameras: LEFT.yaml,RIGHT.yaml");
}

std::pair<std::string, StereoCalibration> read_any_calibration(const std::vector<std::string>& files) {
  for (const auto& file : files)  // tag of matrices in all formats of cv::FileStorage
    if (read_text(file).find("opencv-matrix") != std::string::npos) return {"opencv", read_opencv_calibration(files)};
  std::vector<YamlMap> maps;
  for (const auto& file : files) maps.emplace_back(file, kFormats);
  const auto all_have = [&](const char* key) {
    return std::all_of(maps.begin(), maps.end(), [&](const YamlMap& map) { return map.has(key); });
  };
  if (all_have("T_BS") || all_have("sensor_type"))
    return {"euroc", read_euroc_sensors(maps[0], second_of(maps, "sensor.yaml"))};
  if (all_have("camera_matrix")) return {"ros", read_ros_camera_infos(maps[0], second_of(maps, "camera_info"))};
  if (maps.size() == 2) fail(files[1], first_keys(maps[1]), "one file, or one of each camera");
  if (maps[0].has("cam0")) return {"kalibr", read_kalibr_chain(maps[0])};
  if (maps[0].has("left_model")) return {"native", read_native_calibration(maps[0])};
  fail(files[0], first_keys(maps[0]), kFormats);
}

/// \throws DataError for a baseline that a stereo camera cannot have: zero, or with the right camera on the left.
void check_baseline(const StereoCalibration& calibration) {
  const Eigen::Vector3d right = calibration.right_from_left.inverse().translation();  // in the left camera frame
  std::ostringstream place;
  place << "(" << right.x() << ", " << right.y() << ", " << right.z() << ") m";
  constexpr double kShortest = 1e-6;  // m
  if (!(right.norm() > kShortest) || !right.allFinite())
    fail(calibration.files, "a right camera at " + place.str() + " from the left one", "a baseline above zero");
  if (right.x() < 0 && -right.x() >= std::abs(right.y())) {
    fail(calibration.files, "a right camera at " + place.str() + " in the left one's frame, which is on its left",
         "x above zero: the cameras are exchanged or a transform is inverted");
  }
}

}  // namespace

Eigen::Matrix3d rotation_of_vector(const Eigen::Vector3d& vector, const std::string& where) {
  const double angle = vector.norm();
  if (!(angle <= 1.001 * kPi))
    fail(where, "a rotation by " + format_exact(angle) + " rad", "a vector of at most pi: degrees, perhaps");
  return rotation_by(vector);
}

StereoCalibration finished(StereoCalibration calibration, const std::string& format, const std::string& files) {
  calibration.format = format;
  calibration.files = files;
  check_baseline(calibration);
  calibration.right_from_left = rounded_transform(calibration.right_from_left);
  return calibration;
}

void check_lens(const Lens& lens, const std::string& file, const std::string& camera_key,
                const std::string& coefficients_key) {
  if (const auto complaint = complaint_about(lens.camera))
    fail(file + " (" + camera_key + ")", complaint->found, complaint->expected);
  const auto& k = lens.parameters;
  const std::string where = file + " (" + coefficients_key + ")";
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
    case LensModel::omnidirectional:
      count_is({1, 5, 6, 9, 13, 15}, "xi and 0, 4, 5, 8, 12 or 14 coefficients");
      require(k[0] >= 0, "xi = " + format_exact(k[0]), "0 or more");
      break;
  }
}

void set_image_sizes(StereoCalibration& calibration, ImageSize left, ImageSize right, const std::string& images) {
  const auto set = [&](PinholeCamera& camera, ImageSize size, const char* which) {
    if (camera.width == 0) {
      camera.width = size.width;
      camera.height = size.height;
    }
    const ImageSize said{camera.width, camera.height};
    if (said != size)
      fail(images, std::string(which) + " images of " + to_string(size) + " pixels",
           to_string(said) + ", as " + calibration.files + " says");
  };
  set(calibration.left.camera, left, "left");
  set(calibration.right.camera, right, "right");
}

}  // namespace data

StereoCalibration read_calibration(const std::string& files) {
  auto [format, calibration] = data::read_any_calibration(data::file_list(files));
  return data::finished(std::move(calibration), format, files);
}

}  // namespace quadedge
