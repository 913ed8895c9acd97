# Writes one C++ source that holds a fingerprint of everything that decides the pixels of the rendered scenes: the
# renderer's sources and how they are compiled. Kept images of an older renderer are thereby rendered anew.
# Included; leaves its path in renderer_version_source.
file(GLOB renderer_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/host/workbench/scenes/*.?pp
  ${CMAKE_CURRENT_SOURCE_DIR}/include/quadedge/synthetic.hpp ${CMAKE_CURRENT_SOURCE_DIR}/include/quadedge/camera.hpp)
set(fingerprint "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR}")
string(APPEND fingerprint " ${CMAKE_BUILD_TYPE} ${CMAKE_CXX_FLAGS}")
foreach(file ${renderer_files})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(SHA256 ${file} hash)
  string(APPEND fingerprint " ${hash}")
endforeach()
string(SHA256 fingerprint "${fingerprint}")
set(renderer_version_source ${CMAKE_CURRENT_BINARY_DIR}/renderer_version.cpp)
file(CONFIGURE OUTPUT ${renderer_version_source} CONTENT [[
// Generated; do not edit.
#include "data/rendered_frames.hpp"

namespace quadedge::data {
const char* renderer_version() { return "@fingerprint@"; }
}  // namespace quadedge::data
]] @ONLY)
