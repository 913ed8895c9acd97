#pragma once
/// \file file_list.hpp  Lists of files such as "LEFT,RIGHT" on the command line.

#include <filesystem>
#include <string>
#include <vector>

namespace quadedge::data {

/// The one or two files of an option, separated by a comma: by one that leaves two existing files, else by the first.
/// An existing file whose name contains a comma is one file.
inline std::vector<std::string> file_list(const std::string& files) {
  const auto exists = [](const std::string& file) {
    std::error_code ignored;
    return std::filesystem::exists(file, ignored);
  };
  const auto first = files.find(',');
  if (first == std::string::npos || exists(files)) return {files};
  for (auto comma = first; comma != std::string::npos; comma = files.find(',', comma + 1))
    if (exists(files.substr(0, comma)) && exists(files.substr(comma + 1)))
      return {files.substr(0, comma), files.substr(comma + 1)};
  return {files.substr(0, first), files.substr(first + 1)};
}

}  // namespace quadedge::data
