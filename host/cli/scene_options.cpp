#include "cli/scene_options.hpp"

namespace quadedge::cli {

void declare_scene(Options& options, SyntheticOptions& scene, std::string& size) {
  options.choice("--scene", scene.scene, {"room", "cables"}, "room, or cables: thin curves before a plain wall");
  options.number("--frames", scene.frames, "length of the sequence");
  options.text("--size", size, "size of the images [px]; default 942x489", "WxH");
  options.group("What disturbs the rendered camera");
  options.number("--noise", scene.noise, "standard deviation of the camera noise [grey levels]");
  options.number("--gain", scene.gain, "factor on the light of every second frame");
  options.number("--right-gain", scene.right_gain, "factor on the right camera's exposure");
  options.number("--blur", scene.blur, "length of the motion blur [px]");
  options.number("--mover", scene.mover, "ratio of the image that a board moving on its own covers, 0 to 0.6");
}

}  // namespace quadedge::cli
