#pragma once
/// \file scene_options.hpp  The options of commands that render: the scene, the path and what disturbs the camera.

#include <string>

#include "cli/command.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::cli {

/// What is read as text: "WIDTHxHEIGHT" (see set_size()), and "X,Y,Z" in degrees; the focal length, if not 0 [px].
struct SceneTexts {
  std::string size, right_rotation;
  double focal = 0;
};

/// Declares --scene, --frames, those of declare_view(), --lens and --right-rotation, and the disturbances.
void declare_scene(Options& options, SyntheticOptions& scene, SceneTexts& texts);

/// Puts the texts into the options. \throws UsageError.
void set_texts(SyntheticOptions& scene, const SceneTexts& texts);

/// Declares --path and --size (read into `size`, see set_size()).
void declare_view(Options& options, SyntheticOptions& scene, std::string& size);

/// Whether a command's PATH is the name of a built-in scene; a file or folder of that name goes first.
bool is_scene(const std::string& path);

}  // namespace quadedge::cli
