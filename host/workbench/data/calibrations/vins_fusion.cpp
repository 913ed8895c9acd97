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
  if (model != "PINHOLE" && model != "PINHOLE_FULL" && model != "KANNALA_BRANDT" && model != "MEI")
    camera.complain("model_type", in_quotes(model), "PINHOLE, PINHOLE_FULL, KANNALA_BRANDT or MEI");
  const YamlMap projection = camera.map("projection_parameters");
  const ImageSize size = camera.size("image_width", "image_height");
  StatedLens stated(file, "projection_parameters", "distortion_parameters");
  Lens& lens = stated.lens;
  const auto read = [](const YamlMap& from, std::initializer_list<const char*> names) {
    std::vector<double> values;
    for (const char* name : names) values.push_back(from.number(name));
    return values;
  };
  std::vector<double> k;
  if (model == "PINHOLE") {
    k = read(projection, {"fx", "fy", "cx", "cy"});
    lens.parameters = read(camera.map("distortion_parameters"), {"k1", "k2", "p1", "p2"});
  } else if (model == "PINHOLE_FULL") {
    k = read(projection, {"fx", "fy", "cx", "cy"});
    lens.parameters = read(camera.map("distortion_parameters"), {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"});
  } else if (model == "KANNALA_BRANDT") {
    k = read(projection, {"mu", "mv", "u0", "v0"});
    lens.model = LensModel::equidistant;
    lens.parameters = read(projection, {"k2", "k3", "k4", "k5"});
  } else {  // MEI
    k = read(projection, {"gamma1", "gamma2", "u0", "v0"});
    lens.model = LensModel::omnidirectional;
    lens.parameters = read(camera.map("distortion_parameters"), {"k1", "k2", "p1", "p2"});
    lens.parameters.insert(lens.parameters.begin(), camera.map("mirror_parameters").number("xi"));
  }
  lens.camera = {k[0], k[1], k[2], k[3], size.width, size.height};
  return stated;
}

}  // namespace

StatedCalibration read_vins_fusion(const YamlMap& configuration) {
  const std::filesystem::path folder = std::filesystem::path(configuration.file()).parent_path();
  const YamlMap entries = configuration.as("VINS-Fusion's configuration of two cameras");
  StatedCalibration stated;
  stated.left = read_camodocal((folder / entries.word("cam0_calib")).string());
  if (!entries.has("cam1_calib")) fail(entries.file(), "no entry cam1_calib", "the camera files of both cameras");
  stated.right = read_camodocal((folder / entries.word("cam1_calib")).string());
  const Eigen::Isometry3d body_from_left = entries.transform("body_T_cam0"),
                          body_from_right = entries.transform("body_T_cam1");
  stated.right_from_left = body_from_right.inverse() * body_from_left;
  stated.body_from_left = body_from_left;
  return stated;
}

}  // namespace quadedge::data
