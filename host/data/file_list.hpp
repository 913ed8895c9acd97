#pragma once
/// \file file_list.hpp  Lists of files such as "LEFT,RIGHT" on the command line.

#include <filesystem>
#include <string>
#include <vector>

namespace quadedge::data {

/// The one or two files of an option, separated by a comma. An existing file whose name contains a comma is one file.
inline std::vector<std::string> file_list(const std::string& files) {
  const auto comma = files.find(',');
  std::error_code ignored;
  if (comma == std::string::npos || std::filesystem::exists(files, ignored)) return {files};
  return {files.substr(0, comma), files.substr(comma + 1)};
}

}  // namespace quadedge::data
