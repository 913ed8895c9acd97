#include "data/presets.hpp"

#include "common/nearest_word.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const auto& preset : presets()) names.push_back(preset.name);
  return names;
}

std::vector<TomlEntry> read_preset(const std::string& name) {
  for (const auto& preset : presets())
    if (preset.name == name) return read_toml_text(preset.text, "preset " + name);
  throw UsageError("there is no preset '" + name + "'" + did_you_mean(name, preset_names()));
}

}  // namespace quadedge::data
