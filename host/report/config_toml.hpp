#pragma once
/// \file config_toml.hpp  The effective configuration as a file that `--config` reads again.

#include <string>

#include "quadedge/config.hpp"

namespace quadedge::report {

/// Text of config.toml: device, seed, variants, and every field with its help as a comment.
std::string config_toml(const Config& config, const std::string& device);

}  // namespace quadedge::report
