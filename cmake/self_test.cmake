# Writes self_test_text.cpp, which holds host/frontend/self_test.rows. Sets self_test_source.
set(self_test_source ${CMAKE_CURRENT_BINARY_DIR}/self_test_text.cpp)
set(self_test_file ${CMAKE_CURRENT_SOURCE_DIR}/host/frontend/self_test.rows)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${self_test_file})
file(READ ${self_test_file} self_test_text)
file(CONFIGURE OUTPUT ${self_test_source} @ONLY CONTENT [[
// Generated from host/frontend/self_test.rows; do not edit.
#include "frontend/self_test_record.hpp"

namespace quadedge::frontend {
const std::string& stored_self_test() {
  static const std::string text = R"rows(@self_test_text@)rows";
  return text;
}
}  // namespace quadedge::frontend
]])
