/// \file native.cpp  The program's own calibration format: ten entries; exact lenses, a rounded relative pose.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"
#include "data/toml_file.hpp"
#include "geometry/calibration.hpp"

namespace quadedge::data {
namespace {

/// The names that to_string() gives, and those of Kalibr, EuRoC and ROS.
constexpr std::pair<const char*, LensModel> kModels[] = {{"radtan", LensModel::radial_tangential},
                                                         {"radial-tangential", LensModel::radial_tangential},
                                                         {"plumb_bob", LensModel::radial_tangential},
                                                         {"rational_polynomial", LensModel::radial_tangential},
                                                         {"equidistant", LensModel::equidistant},
                                                         {"fisheye", LensModel::equidistant},
                                                         {"fov", LensModel::field_of_view},
                                                         {"double-sphere", LensModel::double_sphere},
                                                         {"ds", LensModel::double_sphere},
                                                         {"eucm", LensModel::extended_unified},
                                                         {"omni", LensModel::omnidirectional}};

StatedLens read_lens(const YamlMap& file, const std::string& side) {
  const std::string model = file.word(side + "model");
  const auto* found =
      std::find_if(std::begin(kModels), std::end(kModels), [&](const auto& each) { return model == each.first; });
  if (found == std::end(kModels))
    file.complain(side + "model", in_quotes(model), "radtan, equidistant, fov, double-sphere, eucm or omni");
  StatedLens stated(file.file(), side + "intrinsics", side + "coefficients", file.numbers(side + "intrinsics", 4),
                    file.size(side + "size"));
  stated.lens.model = found->second;
  stated.lens.parameters = file.numbers(side + "coefficients");
  return stated;
}

std::string list(const std::vector<double>& values) { return toml_text(values) + "\n"; }  // as in YAML

std::string lens_lines(const Lens& lens, const std::string& side) {
  const PinholeCamera& camera = lens.camera;
  return side + "model: " + to_string(lens.model) + "\n" + side + "size: [" + std::to_string(camera.width) + ", " +
         std::to_string(camera.height) + "]\n" + side +
         "intrinsics: " + list({camera.fx, camera.fy, camera.cx, camera.cy}) + side +
         "coefficients: " + list(lens.parameters);
}

StatedCalibration read_native(const std::vector<CalibrationText>& texts) {
  const YamlMap& file = texts[0].entries();
  StatedCalibration calibration;
  calibration.left = read_lens(file, "left_");
  calibration.right = read_lens(file, "right_");
  calibration.right_from_left.linear() = rotation_of_vector(file.vector("rotation"), file.file() + " (rotation)");
  calibration.right_from_left.translation() = file.vector("translation");
  return calibration;
}

std::vector<std::string> write_native(const StereoCalibration& calibration) {
  const Eigen::Vector3d rotation = rounded_rotation(calibration.right_from_left),
                        translation = rounded(calibration.right_from_left.translation());
  return {
      "# Stereo calibration: pixels, metres, radians. Intrinsics fx fy cx cy; x_right = R x_left + translation, R "
      "the rotation by a vector.\n" +
      lens_lines(calibration.left, "left_") + lens_lines(calibration.right, "right_") +
      "rotation: " + list({rotation.x(), rotation.y(), rotation.z()}) +
      "translation: " + list({translation.x(), translation.y(), translation.z()})};
}

}  // namespace

const CalibrationForm kNative{"native",    "a file written by `quadedge check --write-calibration` (left_model ...)",
                              false,       [](const CalibrationText& text) { return text.has("left_model"); },
                              read_native, write_native};

}  // namespace quadedge::data
