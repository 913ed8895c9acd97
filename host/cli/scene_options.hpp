#pragma once
/// \file scene_options.hpp  The options of commands that render: the scene and what disturbs the camera.

#include <string>

#include "cli/command.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::cli {

/// Declares --scene, --frames, --size (read into `size`, see set_size()), and the disturbances.
void declare_scene(Options& options, SyntheticOptions& scene, std::string& size);

}  // namespace quadedge::cli
