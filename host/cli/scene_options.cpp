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
                 "room; cables: thin curves before a plain wall; facade: siding, brick, a fence and shrubs");
  options.number("--frames", scene.frames, "length of the sequence");
  declare_view(options, scene, texts.size);
  options.choice("--lens", scene.lens, synthetic_lenses(),
                 "of both cameras; wide ones see more than the pinhole camera");
  options.text("--right-rotation", texts.right_rotation,
               "turns the right camera: rotation vector in the left one's axes [degrees]", "X,Y,Z");
  options.group("What disturbs the rendered camera");
  options.number("--noise", scene.noise, "standard deviation of the camera noise [grey levels]");
  options.number("--gain", scene.gain, "factor on the light of every second frame");
  options.number("--right-gain", scene.right_gain, "factor on the right camera's exposure");
  options.number("--light", scene.light, "factor on the light of all frames");
  options.number("--gamma", scene.gamma, "grey levels become 255 (v / 255)^(1 / gamma)");
  options.number("--bits", scene.bits, "of a pixel: 8, 12 or 16");
  options.number("--contrast", scene.contrast, "of the finished picture, noise included, around grey level 128");
  options.number("--blur", scene.blur,
                 "length of the motion blur, on average over the path [px]; what the path moves per frame at most");
  options.number("--mover", scene.mover, "ratio of the image that a board moving on its own covers, 0 to 0.6");
}

void set_texts(SyntheticOptions& scene, const SceneTexts& texts) {
  set_size(scene, texts.size);
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
                 "how the camera of a built-in scene moves; drive: as far as the scene goes, 61 frames, facade 103; "
                 "loop: the last frame is back at the first one's pose");
  options.text("--size", size, "size of the images of built-in scenes [px]; default 942x489", "WxH");
}

bool is_scene(const std::string& path) {
  const auto& scenes = synthetic_scenes();
  return std::find(scenes.begin(), scenes.end(), path) != scenes.end() && !std::filesystem::exists(path);
}

}  // namespace quadedge::cli
