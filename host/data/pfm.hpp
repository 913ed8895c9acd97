#pragma once
/// \file pfm.hpp  Portable float maps: one 32-bit float per pixel, stored bottom row first.

#include <string>
#include <vector>

namespace quadedge::data {

/// height x width, row-major, top row first.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> values;
};

/// \throws DataError when the file is no single-channel PFM or ends early.
FloatImage read_pfm(const std::string& file);

/// Little-endian, written atomically. \throws DataError.
void write_pfm(const std::string& file, const FloatImage& image);

}  // namespace quadedge::data
