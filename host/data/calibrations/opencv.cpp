/// \file opencv.cpp  Results of OpenCV's stereoCalibrate as people store them, in one file or in two (intrinsics.yml,
/// extrinsics.yml): M1 D1 M2 D2 (or K1, cameraMatrix1, distCoeffs1 ...), and R T with x_right = R x_left + T, in
/// metres. YAML, XML or JSON. Optional: image_width and image_height; distortion_model: equidistant for
/// fisheye::stereoCalibrate.

#include <algorithm>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// The names that programs give to the matrices of camera N, and to the transform.
const std::vector<std::string> kCameraNames = {"M", "K", "cameraMatrix", "camera_matrix_", "CM"},
                               kDistortionNames = {"D", "distCoeffs", "dist_coeffs_", "distortion_coefficients_"},
                               kRotationNames = {"R", "rotation_matrix"},
                               kTranslationNames = {"T", "translation_vector", "t"};

/// An entry of one of the files.
struct Place {
  const YamlMap* map;
  std::string key;
};

std::optional<Place> find(const std::vector<CalibrationText>& texts, const std::vector<std::string>& names,
                          const std::string& number) {
  for (const CalibrationText& text : texts)
    for (const std::string& name : names)
      if (text.map->has(name + number)) return Place{&*text.map, name + number};
  return std::nullopt;
}

Place required(const std::vector<CalibrationText>& texts, const std::vector<std::string>& names,
               const std::string& number) {
  if (const auto place = find(texts, names, number)) return *place;
  std::string files;
  for (const CalibrationText& text : texts) files += (files.empty() ? "" : ", ") + text.file;
  fail(files, "no entry " + names[0] + number, "M1 D1 M2 D2 R T, or K1 or cameraMatrix1, distCoeffs1 ...");
}

StatedLens read_lens(const std::vector<CalibrationText>& texts, const std::string& number) {
  const Place k = required(texts, kCameraNames, number), d = required(texts, kDistortionNames, number);
  StatedLens stated(k.map->file(), k.key, d.key);
  set_intrinsics(*k.map, k.key, stated.lens.camera);
  const YamlMatrix coefficients = d.map->matrix(d.key);
  if (coefficients.rows > 1 && coefficients.columns > 1)
    d.map->complain(d.key, "a matrix of several rows and columns", "one row of coefficients");
  stated.lens.parameters = coefficients.values;
  if (const auto model = find(texts, {"distortion_model"}, "")) {
    const std::string word = model->map->word(model->key);
    if (word == "equidistant" || word == "fisheye") {
      stated.lens.model = LensModel::equidistant;
    } else if (word != "plumb_bob" && word != "radtan" && word != "radial-tangential" &&
               word != "rational_polynomial") {
      model->map->complain(model->key, "'" + word + "'",
                           "plumb_bob, radtan, rational_polynomial, equidistant or fisheye");
    }
  }
  if (const auto width = find(texts, {"image_width"}, "")) {
    const ImageSize size = width->map->size("image_width", "image_height");
    stated.lens.camera.width = size.width;
    stated.lens.camera.height = size.height;
  }
  return stated;
}

Eigen::Matrix3d read_rotation(const Place& place) {
  if (place.map->matrix(place.key).values.size() == 3)
    return rotation_of_vector(place.map->vector(place.key), place.map->file() + " (" + place.key + ")");
  return place.map->rotation(place.key);
}

}  // namespace

bool is_opencv_stereo(const CalibrationText& text) {
  if (!text.map) return false;
  const auto has_any = [&](const std::vector<std::string>& names, const char* number) {
    return std::any_of(names.begin(), names.end(), [&](const auto& name) { return text.map->has(name + number); });
  };
  return has_any(kCameraNames, "1") || has_any(kCameraNames, "2") || has_any(kRotationNames, "") ||
         has_any(kTranslationNames, "");
}

StatedCalibration read_opencv_stereo(const std::vector<CalibrationText>& texts) {
  StatedCalibration stated;
  stated.left = read_lens(texts, "1");
  stated.right = read_lens(texts, "2");
  stated.right_from_left.linear() = read_rotation(required(texts, kRotationNames, ""));
  const Place translation = required(texts, kTranslationNames, "");
  stated.right_from_left.translation() = translation.map->vector(translation.key);
  return stated;
}

}  // namespace quadedge::data
