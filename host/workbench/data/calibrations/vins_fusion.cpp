/// \file vins_fusion.cpp  VINS-Fusion: a configuration with body_T_cam0 and body_T_cam1 (poses of the cameras in the
/// IMU frame, metres), which names a camera file of camodocal for each: model_type PINHOLE, KANNALA_BRANDT or MEI.

#include <filesystem>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

StatedLens read_camodocal(const std::string& file) {
  const YamlMap camera(file, "a camera file of camodocal (model_type, projection_parameters)");
  const std::string model = camera.word("model_type");
  const bool is_full = model == "PINHOLE_FULL", is_fisheye = model == "KANNALA_BRANDT", is_mei = model == "MEI";
  if (model != "PINHOLE" && !is_full && !is_fisheye && !is_mei)
    camera.complain("model_type", in_quotes(model), "PINHOLE, PINHOLE_FULL, KANNALA_BRANDT or MEI");
  const YamlMap projection = camera.map("projection_parameters");
  std::vector<const char*> k = {"fx", "fy", "cx", "cy"}, coefficients = {"k1", "k2", "p1", "p2"};
  if (is_full) coefficients.insert(coefficients.end(), {"k3", "k4", "k5", "k6"});
  if (is_fisheye) coefficients = {"k2", "k3", "k4", "k5"};
  if (is_fisheye || is_mei) k = {is_mei ? "gamma1" : "mu", is_mei ? "gamma2" : "mv", "u0", "v0"};
  StatedLens stated(file, "projection_parameters", "distortion_parameters", projection.numbers_of(k),
                    camera.size("image_width", "image_height"));
  auto& parameters = stated.lens.parameters;
  parameters = (is_fisheye ? projection : camera.map("distortion_parameters")).numbers_of(coefficients);
  if (is_fisheye) stated.lens.model = LensModel::equidistant;
  if (is_mei) {
    stated.lens.model = LensModel::omnidirectional;
    parameters.insert(parameters.begin(), camera.map("mirror_parameters").number("xi"));
  }
  return stated;
}

StatedCalibration read_vins_fusion(const std::vector<CalibrationText>& texts) {
  const YamlMap& configuration = texts[0].entries();
  const std::filesystem::path folder = std::filesystem::path(configuration.file()).parent_path();
  const YamlMap entries = configuration.as("VINS-Fusion's configuration of two cameras");
  StatedCalibration stated;
  stated.left = read_camodocal((folder / entries.word("cam0_calib")).string());
  if (!entries.has("cam1_calib")) fail(entries.file(), "no entry cam1_calib", "the camera files of both cameras");
  stated.right = read_camodocal((folder / entries.word("cam1_calib")).string());
  stated.body_from_left = entries.transform("body_T_cam0");
  stated.right_from_left = entries.transform("body_T_cam1").inverse() * *stated.body_from_left;
  return stated;
}

}  // namespace

const CalibrationForm kVinsFusion{
    "vins-fusion", "VINS-Fusion's configuration (body_T_cam0, cam0_calib)", false,
    [](const CalibrationText& text) { return text.has("cam0_calib") || text.has("body_T_cam0"); }, read_vins_fusion};

}  // namespace quadedge::data
