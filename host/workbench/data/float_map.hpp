#pragma once
/// \file float_map.hpp  Depth or disparity maps in PFM files, one 32-bit float per pixel.

#include <string>
#include <vector>

namespace quadedge::data {

/// height x width, row-major, top row first.
struct FloatMap {
  int width = 0, height = 0;
  std::vector<float> values;
};

/// The stored values, including infinite ones. \throws DataError if the file is not a PFM with one channel or is
/// incomplete
FloatMap read_float_map(const std::string& file);

/// Little-endian, written atomically. \throws DataError
void write_float_map(const std::string& file, const FloatMap& map);

}  // namespace quadedge::data
