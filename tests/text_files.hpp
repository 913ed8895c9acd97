#pragma once
/// \file text_files.hpp  Whole text files.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Makes the folder, too.
inline void write_text(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::absolute(path).parent_path());
  std::ofstream(path, std::ios::binary) << text;
}
