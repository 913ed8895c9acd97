# Writes presets.cpp, which holds the texts of the presets in config/. Sets preset_source.
set(preset_source ${CMAKE_CURRENT_BINARY_DIR}/presets.cpp)
set(preset_texts "")
foreach(name fast default dense paper)
  set(file ${CMAKE_CURRENT_SOURCE_DIR}/config/${name}.toml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  string(APPEND preset_texts "      {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${preset_source} @ONLY CONTENT [[
// Generated from config/*.toml; do not edit.
#include "data/toml_file.hpp"

namespace quadedge::data {
const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
@preset_texts@  };
  return all;
}
}  // namespace quadedge::data
]])
