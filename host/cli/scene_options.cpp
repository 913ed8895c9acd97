#include "cli/scene_options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/frame_source.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {

void declare_scene(Options& options, SyntheticOptions& scene, SceneTexts& texts) {
  options.choice("--scene", scene.scene, synthetic_scenes(),
                 "room; cables: thin curves in front of a plain wall; facade: siding, brick, a fence and shrubs; "
                 "corridor: equal doors");
  options.number("--frames", scene.frames, "number of frames");
  declare_view(options, scene, texts.size);
  options.choice("--rig", scene.rig, synthetic_rigs(),
                 "cameras; eth3d-slam: those of cables_2, of different size and not rectified, which exclude the "
                 "following options and --size");
  options.number("--focal", texts.focal, "focal length [px]; 0: the same field of view for every size");
  options.number("--baseline", scene.baseline, "distance between the cameras [m]");
  options.choice("--lens", scene.lens, synthetic_lenses(),
                 "lens of both cameras; wide ones see more than the pinhole camera");
  options.text("--right-rotation", texts.right_rotation,
               "rotation vector of the right camera, in the axes of the left one [degrees]", "X,Y,Z");
  options.group("Disturbances of the rendered images");
  options.number("--noise", scene.noise, "standard deviation of the camera noise [grey levels]");
  options.number("--gain", scene.gain, "light factor of every second frame");
  options.number("--right-gain", scene.right_gain, "exposure factor of the right camera");
  options.number("--light", scene.light, "light factor of all frames");
  options.number("--gamma", scene.gamma, "grey levels become 255 (v / 255)^(1 / gamma)");
  options.number("--bits", scene.bits, "bits per pixel: 8, 12 or 16");
  options.number("--contrast", scene.contrast,
                 "contrast factor around grey level 128, applied to the finished image, noise included");
  options.number("--blur", scene.blur,
                 "mean length of the motion blur along the path [px]; at most the motion between frames");
  options.number("--mover", scene.mover, "fraction of the image covered by a board that moves independently, 0 to 0.6");
}

void set_texts(SyntheticOptions& scene, const SceneTexts& texts) {
  const SyntheticOptions defaults;
  const bool states_cameras = !texts.size.empty() || !texts.right_rotation.empty() || texts.focal != 0 ||
                              scene.baseline != defaults.baseline || scene.lens != defaults.lens;
  if (scene.rig != defaults.rig && states_cameras)
    throw UsageError("--rig " + scene.rig + " excludes --size, --focal, --baseline, --lens and --right-rotation");
  set_size(scene, texts.size);
  if (texts.focal != 0) scene.focal = texts.focal;
  if (texts.right_rotation.empty()) return;
  double x = 0, y = 0, z = 0;
  int length = 0;
  if (std::sscanf(texts.right_rotation.c_str(), "%lf,%lf,%lf%n", &x, &y, &z, &length) != 3 ||
      length != static_cast<int>(texts.right_rotation.size()) || !std::isfinite(x + y + z)) {
    throw UsageError("--right-rotation " + texts.right_rotation + ": expected X,Y,Z in degrees, for example 0,2,0");
  }
  scene.right_rotation = {x, y, z};
}

void declare_view(Options& options, SyntheticOptions& scene, std::string& size) {
  options.choice("--path", scene.path, synthetic_paths(),
                 "camera path in a built-in scene; drive: to the end of the scene (61 frames, facade: 103, corridor: "
                 "119); loop: returns "
                 "to the first pose");
  options.text("--size", size, "image size of built-in scenes [px]; default 942x489", "WxH");
}

bool is_scene(const std::string& path) {
  const auto& scenes = synthetic_scenes();
  return std::find(scenes.begin(), scenes.end(), path) != scenes.end() && !std::filesystem::exists(path);
}

}  // namespace quadedge::cli
