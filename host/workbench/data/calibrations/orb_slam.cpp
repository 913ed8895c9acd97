/// \file orb_slam.cpp  Settings of ORB-SLAM2 and ORB-SLAM3. Flat entries: Camera1.fx or Camera.fx, Camera2.fx;
/// Stereo.T_c1_c2 or Tlr, the pose of the right camera in the left one's frame [m]; for rectified images Stereo.b [m]
/// or Camera.bf [px m]; LEFT.K, LEFT.D, LEFT.R, LEFT.P for images that the program rectifies.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

ImageSize size_in(const YamlMap& settings) {
  for (const char* prefix : {"Camera.", "LEFT."})
    if (settings.has(std::string(prefix) + "width"))
      return settings.size(std::string(prefix) + "width", std::string(prefix) + "height");
  return {};
}

StatedLens read_lens(const YamlMap& settings, const std::string& prefix, bool is_rectified) {
  StatedLens stated(settings.file(), prefix + "fx", prefix + "k1",
                    settings.numbers_of({"fx", "fy", "cx", "cy"}, prefix), size_in(settings));
  Lens& lens = stated.lens;
  if (is_rectified) {
    for (const char* name : {"k1", "k2", "k3", "p1", "p2"})
      if (settings.has(prefix + name) && settings.number(prefix + name) != 0)
        settings.complain(prefix + name, "distortion of rectified images", "0, or Stereo.T_c1_c2 and Camera2.fx ...");
    return stated;
  }
  if (!settings.has(prefix + "k1")) return stated;
  const std::string type = settings.has("Camera.type") ? settings.word("Camera.type") : "PinHole";
  if (type == "KannalaBrandt8")
    lens.model = LensModel::equidistant;
  else if (type != "PinHole" && type != "Pinhole")
    settings.complain("Camera.type", in_quotes(type), "PinHole, Rectified or KannalaBrandt8");
  const bool is_fisheye = lens.model == LensModel::equidistant;
  lens.parameters = settings.numbers_of({"k1", "k2", is_fisheye ? "k3" : "p1", is_fisheye ? "k4" : "p2"}, prefix);
  if (!is_fisheye && settings.has(prefix + "k3")) lens.parameters.push_back(settings.number(prefix + "k3"));
  return stated;
}

/// LEFT.K, LEFT.D, LEFT.R, LEFT.P of ORB-SLAM2: what camera_info calls K, D, R, P.
StatedLens read_recording_lens(const YamlMap& settings, const std::string& side) {
  return read_matrix_lens(settings, side + "K", side + "D", settings.size(side + "width", side + "height"));
}

StatedCalibration read_orb_slam(const std::vector<CalibrationText>& texts) {
  const YamlMap& settings = texts[0].entries();
  StatedCalibration stated;
  if (settings.has("LEFT.K")) {
    stated.left = read_recording_lens(settings, "LEFT.");
    stated.right = read_recording_lens(settings, "RIGHT.");
    const auto rectification = [&](const std::string& side) {
      return Rectification{settings.rotation(side + "R"), projection_offset(settings, side + "P")};
    };
    stated.right_from_left = right_from_left_of(rectification("LEFT."), rectification("RIGHT."));
    stated.of_rectified.push_back(rectified_cameras(settings, "LEFT.P", settings.size("LEFT.width", "LEFT.height"),
                                                    settings, "RIGHT.P", settings.size("RIGHT.width", "RIGHT.height")));
    return stated;
  }
  const std::string left = settings.has("Camera1.fx") ? "Camera1." : "Camera.";
  for (const char* transform : {"Stereo.T_c1_c2", "Tlr"}) {
    if (!settings.has(transform)) continue;
    stated.left = read_lens(settings, left, false);
    stated.right = read_lens(settings, "Camera2.", false);
    stated.right_from_left = settings.transform(transform).inverse();
    return stated;
  }
  for (const char* depth : {"DepthMapFactor", "RGBD.DepthMapFactor"})
    if (settings.has(depth)) settings.complain(depth, "the settings of a depth camera", "those of two cameras");
  const bool has_baseline = settings.has("Stereo.b");
  if (!has_baseline && !settings.has("Camera.bf"))
    fail(settings.file(), "no pose of the right camera",
         "Stereo.T_c1_c2 or Tlr, or for rectified images Stereo.b or Camera.bf: are these settings of one camera?");
  stated.left = stated.right = read_lens(settings, left, true);
  stated.right_from_left.translation().x() =
      has_baseline ? -settings.number("Stereo.b") : -settings.number("Camera.bf") / stated.left.lens.camera.fx;
  return stated;
}

}  // namespace

const CalibrationForm kOrbSlam{"orb-slam", "ORB-SLAM2 or ORB-SLAM3 settings (Camera1.fx or Camera.fx)", false,
                               [](const CalibrationText& text) {
                                 return text.has("Camera1.fx") || (text.has("Camera.fx") && !text.has("Camera.setup"));
                               },
                               read_orb_slam};

}  // namespace quadedge::data
