/// \file euroc.cpp  EuRoC: one sensor.yaml per camera; T_BS maps points from the camera frame to the body frame. Lenses
/// in its notation, which is Kalibr's too: a camera model, a distortion model, and their parameters.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::data {
namespace {

/// Number of values in `intrinsics` before fx fy cx cy.
std::size_t leading_numbers(const std::string& camera_model, const YamlMap& camera) {
  if (camera_model == "pinhole") return 0;
  if (camera_model == "omni") return 1;  // xi
  if (camera_model == "ds") return 2;    // xi alpha
  if (camera_model == "eucm") return 2;  // alpha beta
  camera.complain("camera_model", in_quotes(camera_model), "pinhole, omni, ds or eucm");
}

LensModel distortion_of(const std::string& word, const YamlMap& camera) {
  if (word == "radtan" || word == "radial-tangential" || word == "none") return LensModel::radial_tangential;
  if (word == "equidistant") return LensModel::equidistant;
  if (word == "fov") return LensModel::field_of_view;
  camera.complain("distortion_model", in_quotes(word), "radtan (radial-tangential), equidistant, fov or none");
}

}  // namespace

StatedLens read_named_lens(const YamlMap& camera, const std::string& coefficients) {
  const std::string model = camera.word("camera_model");
  const std::size_t leading = leading_numbers(model, camera);
  // Kalibr writes no distortion model behind ds and eucm in some versions.
  const std::string word = leading == 2 && !camera.has("distortion_model") ? "none" : camera.word("distortion_model");
  const LensModel distortion = distortion_of(word, camera);
  const auto intrinsics = camera.numbers("intrinsics", leading + 4);
  StatedLens stated(camera.file(), camera.name("intrinsics"), camera.name(coefficients),
                    {intrinsics.end() - 4, intrinsics.end()}, camera.size("resolution"));
  Lens& lens = stated.lens;
  lens.model = distortion;
  if (word != "none") lens.parameters = camera.numbers(coefficients);
  const bool radial = lens.model == LensModel::radial_tangential;
  if (model == "omni") {
    if (!radial) camera.complain("distortion_model", in_quotes(word), "radtan or none behind camera_model omni");
    lens.model = LensModel::omnidirectional;
    lens.parameters.insert(lens.parameters.begin(), intrinsics[0]);
  } else if (model == "ds" || model == "eucm") {
    if (word != "none") camera.complain("distortion_model", in_quotes(word), "none behind camera_model " + model);
    lens.model = model == "ds" ? LensModel::double_sphere : LensModel::extended_unified;
    lens.parameters = {intrinsics[0], intrinsics[1]};
  }
  return stated;
}

namespace {

StatedCalibration read_sensors(const YamlMap& left, const YamlMap& right) {
  StatedCalibration calibration;
  calibration.left = read_named_lens(left, "distortion_coefficients");
  calibration.right = read_named_lens(right, "distortion_coefficients");
  calibration.body_from_left = left.map("T_BS").transform("data");
  calibration.right_from_left = right.map("T_BS").transform("data").inverse() * *calibration.body_from_left;
  return calibration;
}

StatedCalibration read_euroc_sensors(const std::vector<CalibrationText>& texts) {
  return read_sensors(texts[0].entries(), texts[1].entries());
}

}  // namespace

StereoCalibration read_euroc_calibration(const std::string& left, const std::string& right) {
  constexpr const char* kSensorFile = "the sensor.yaml of a EuRoC camera";
  return judged(read_sensors({left, kSensorFile}, {right, kSensorFile}), "euroc", left + "," + right);
}

const CalibrationForm kEurocSensors{
    "euroc", "EuRoC's sensor.yaml (T_BS)", true,
    [](const CalibrationText& text) { return text.has("T_BS") || text.has("sensor_type"); }, read_euroc_sensors};

}  // namespace quadedge::data
