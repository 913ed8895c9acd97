/// \file stella_vslam.cpp  Configuration of stella_vslam and OpenVSLAM: Camera (fx fy cx cy, cols, rows,
/// focal_x_baseline [px m]) describes the rectified images, StereoRectifier (K_left, D_left, R_left ...) the cameras,
/// if the program rectifies. Maps, or flat entries such as Camera.fx.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// The entries below a heading, nested or flat.
struct Section {
  YamlMap map;
  std::string prefix;
  std::string key(const std::string& name) const { return prefix + name; }
};

Section section(const YamlMap& settings, const std::string& name) {
  if (settings.has(name)) return {settings.map(name), ""};
  return {settings, name + "."};
}

StatedLens read_recording_lens(const Section& rectifier, const std::string& side, ImageSize size) {
  StatedLens stated = read_matrix_lens(rectifier.map, rectifier.key("K_" + side), rectifier.key("D_" + side), size);
  if (rectifier.map.has(rectifier.key("model")) && rectifier.map.word(rectifier.key("model")) == "fisheye")
    stated.lens.model = LensModel::equidistant;
  return stated;
}

StatedCalibration read_stella_vslam(const std::vector<CalibrationText>& texts) {
  const YamlMap& settings = texts[0].entries();
  const Section camera = section(settings, "Camera"), rectifier = section(settings, "StereoRectifier");
  const YamlMap& map = camera.map;
  if (const std::string setup = map.has(camera.key("setup")) ? map.word(camera.key("setup")) : ""; setup != "stereo")
    fail(map.file(), "setup " + in_quotes(setup), "setup: stereo");
  const ImageSize size = map.size(camera.key("cols"), camera.key("rows"));
  const double focal = map.number(camera.key("fx"));
  Rectification left, right;
  right.rectified_from_reference.x() = -map.number(camera.key("focal_x_baseline")) / focal;
  StatedCalibration rectified;
  rectified.left = StatedLens(map.file(), map.name(camera.key("fx")), map.name(camera.key("fx")),
                              map.numbers_of({"fx", "fy", "cx", "cy"}, camera.prefix), size);
  rectified.right = rectified.left;
  rectified.right_from_left = right_from_left_of(left, right);
  if (!rectifier.map.has(rectifier.key("K_left"))) {
    for (const char* name : {"k1", "k2", "k3", "k4", "p1", "p2"})
      if (map.has(camera.key(name)) && map.number(camera.key(name)) != 0)
        map.complain(camera.key(name), "distortion without StereoRectifier", "0, as rectified images have it");
    return rectified;
  }
  StatedCalibration stated;
  stated.left = read_recording_lens(rectifier, "left", size);
  stated.right = read_recording_lens(rectifier, "right", size);
  left.rectified_from_camera = rectifier.map.rotation(rectifier.key("R_left"));
  right.rectified_from_camera = rectifier.map.rotation(rectifier.key("R_right"));
  stated.right_from_left = right_from_left_of(left, right);
  stated.of_rectified.push_back(std::move(rectified));
  return stated;
}

}  // namespace

const CalibrationForm kStellaVslam{
    "stella-vslam", "stella_vslam's configuration (Camera: setup: stereo)", false,
    [](const CalibrationText& text) { return text.has("Camera.setup") || (text.has("Camera") && !text.has("value0")); },
    read_stella_vslam};

}  // namespace quadedge::data
