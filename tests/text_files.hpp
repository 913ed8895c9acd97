#pragma once
/// \file text_files.hpp  Whole text files.

#include <fstream>
#include <iterator>
#include <string>

inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
