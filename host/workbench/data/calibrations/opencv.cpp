/// \file opencv.cpp  Results of OpenCV's stereoCalibrate as people store them, in one file or in two (intrinsics.yml,
/// extrinsics.yml): M1 D1 M2 D2 (or K1, cameraMatrix1, distCoeffs1 ...), and R T with x_right = R x_left + T, in
/// metres. YAML, XML or JSON. Optional: image_width and image_height; distortion_model: equidistant for
/// fisheye::stereoCalibrate.

#include <cctype>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

/// The names that programs give to the matrices of a camera, what they have before or behind them for the left and
/// right one, and the names of the transform; without case and separators: Camera_Matrix_Left is cameramatrixleft.
using Words = std::vector<std::string>;
const Words kCameraNames = {"m", "k", "cameramatrix", "cammatrix", "cammtx", "mtx", "cm"},
            kDistortionNames = {"d",          "distcoeffs", "distcoeff", "distortioncoefficients", "distortioncoeffs",
                                "distortion", "dist"},
            kLeft = {"1", "l", "left"}, kRight = {"2", "r", "right"},
            kRotationNames = {"r", "rotation", "rotationmatrix", "rot", "rvec", "stereor", "extrinsicsr"},
            kTranslationNames = {"t", "translation", "translationvector", "trans", "tvec", "stereot", "extrinsicst"};

/// An entry of one of the files, or of a map in it ("left: {K: ...}").
struct Place {
  std::optional<YamlMap> map;
  std::string key;
};

std::string plain(const std::string& name) {
  std::string letters;
  for (const char letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return letters;
}

/// All entries by their plain names; those of a map other than a matrix follow its name.
std::vector<std::pair<std::string, Place>> entries_of(const CalibrationText& text) {
  std::vector<std::pair<std::string, Place>> entries;
  if (!text.map) return entries;
  for (const std::string& key : text.map->keys()) {
    entries.emplace_back(plain(key), Place{text.map, key});
    if (!text.map->holds_map(key)) continue;
    const YamlMap inner = text.map->map(key);
    if (inner.has("data")) continue;
    for (const std::string& name : inner.keys()) entries.emplace_back(plain(key + name), Place{inner, name});
  }
  return entries;
}

std::optional<Place> find(const std::vector<CalibrationText>& texts, const Words& names, const Words& sides = {""}) {
  for (const CalibrationText& text : texts) {
    const auto entries = entries_of(text);
    for (const std::string& name : names)
      for (const std::string& side : sides)
        for (const auto& [word, place] : entries)
          if (word == name + side || word == side + name) return place;
  }
  return std::nullopt;
}

Place required(const std::vector<CalibrationText>& texts, const Words& names, const Words& sides = {""}) {
  if (const auto place = find(texts, names, sides)) return *place;
  std::string files;
  for (const CalibrationText& text : texts) files += (files.empty() ? "" : ", ") + text.file;
  std::string name = names[0] + sides[0];
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  fail(files, "no entry " + name, "M1 D1 M2 D2 R T, or K1 or cameraMatrix1, distCoeffs1 ...");
}

StatedLens read_lens(const std::vector<CalibrationText>& texts, const Words& side) {
  const Place k = required(texts, kCameraNames, side), d = required(texts, kDistortionNames, side);
  StatedLens stated(k.map->file(), k.key, d.key);
  set_intrinsics(*k.map, k.key, stated.lens.camera);
  stated.lens.parameters = coefficients_of(*d.map, d.key);
  if (const auto model = find(texts, {"distortionmodel"}))
    stated.lens.model = model_of_word(*model->map, model->key, model->map->word(model->key));
  if (const auto width = find(texts, {"imagewidth"}), height = find(texts, {"imageheight"}); width && height)
    set_size(stated.lens.camera, width->map->size(width->key, height->key));
  return stated;
}

Eigen::Matrix3d read_rotation(const Place& place) {
  if (place.map->matrix(place.key).values.size() == 3)
    return rotation_of_vector(place.map->vector(place.key), place.map->file() + " (" + place.key + ")");
  return place.map->rotation(place.key);
}

bool is_opencv_stereo(const CalibrationText& text) {
  return find({text}, kCameraNames, kLeft) || find({text}, kCameraNames, kRight) || find({text}, kRotationNames) ||
         find({text}, kTranslationNames);
}

StatedCalibration read_opencv_stereo(const std::vector<CalibrationText>& texts) {
  StatedCalibration stated;
  stated.left = read_lens(texts, kLeft);
  stated.right = read_lens(texts, kRight);
  stated.right_from_left.linear() = read_rotation(required(texts, kRotationNames));
  const Place translation = required(texts, kTranslationNames);
  stated.right_from_left.translation() = translation.map->vector(translation.key);
  if (const auto left = find(texts, {"p"}, kLeft), right = find(texts, {"p"}, kRight); left && right) {
    stated.of_rectified.push_back(rectified_cameras(*left->map, left->key, size_of(stated.left.lens.camera),
                                                    *right->map, right->key, size_of(stated.right.lens.camera)));
  }
  return stated;
}

std::vector<std::string> write_opencv_stereo(const StereoCalibration& calibration) {
  const Lens &left = calibration.left, &right = calibration.right;
  if (size_of(left.camera) != size_of(right.camera))
    throw UsageError("format opencv: expected images of one size from both cameras");
  std::string text = "%YAML:1.0\n---\nimage_width: " + std::to_string(left.camera.width) +
                     "\nimage_height: " + std::to_string(left.camera.height) + "\n";
  if (left.model == LensModel::equidistant) text += "distortion_model: equidistant\n";
  const auto matrix = [&](const std::string& name, std::size_t rows, const std::vector<double>& values) {
    text += matrix_lines(name, rows, values, "!!opencv-matrix");
  };
  for (const Side side : kSides) {
    const Lens& lens = side == Side::left ? left : right;
    if (lens.model != left.model ||
        (lens.model != LensModel::radial_tangential && lens.model != LensModel::equidistant))
      refuse_lens("opencv", lens, side, "both lenses to be radtan, or both equidistant");
    const std::string number = side == Side::left ? "1" : "2";
    matrix("M" + number, 3, row_major(lens.camera.matrix()));
    matrix("D" + number, 1, lens.parameters.empty() ? std::vector<double>(5) : lens.parameters);
  }
  matrix("R", 3, row_major(calibration.right_from_left.linear()));
  matrix("T", 3, row_major(calibration.right_from_left.translation()));
  return {text};
}

}  // namespace

const CalibrationForm kOpencvStereo{
    "opencv",
    "OpenCV's stereo calibration in one or two files (M1 D1 M2 D2 R T, or K1 or cameraMatrix1 ...)",
    false,
    is_opencv_stereo,
    read_opencv_stereo,
    write_opencv_stereo};

}  // namespace quadedge::data
