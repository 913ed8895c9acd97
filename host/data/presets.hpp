#pragma once
/// \file presets.hpp  Presets: named configuration files of config/, embedded in the program.

#include <string>
#include <vector>

#include "data/toml_file.hpp"

namespace quadedge::data {

struct Preset {
  std::string name;
  std::string text;  ///< TOML
};

/// By the number of edges.
const std::vector<Preset>& presets();

std::vector<std::string> preset_names();

/// The entries of a preset; messages refer to it as "preset NAME". \throws UsageError for an unknown name
std::vector<TomlEntry> read_preset(const std::string& name);

}  // namespace quadedge::data
