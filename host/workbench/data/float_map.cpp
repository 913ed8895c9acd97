/// \file float_map.cpp  PFM: rows from the bottom up, the byte order by the sign of the scale.
#include "data/float_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "data/atomic_file.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

struct Header {
  int width = 0, height = 0;
  bool big_endian = false;
  std::size_t pixels = 0;  ///< position of the first float
};

/// The sign of the scale gives the byte order. Its size is left alone: published maps hold pixels or metres whatever it
/// is (Middlebury's own writer puts 1/255 there).
Header read_header(const std::string& bytes, const std::string& file) {
  constexpr std::size_t kLongestHeader = 100;  // bytes
  const auto words = split(std::string_view(bytes).substr(0, kLongestHeader), kSpace);
  if (words.size() < 4 || words[0] != "Pf") {
    fail(file, bytes.empty() ? "an empty file" : "bytes that start with " + in_quotes(bytes.substr(0, 8)),
         "\"Pf\", width, height and scale, then one float per pixel");
  }
  const double width = parse_number(words[1], file, 2, "width"), height = parse_number(words[2], file, 2, "height");
  const double scale = parse_number(words[3], file, 3, "scale, negative for little-endian");
  const auto is_side = [](double side) { return side >= 1 && side == std::floor(side) && side < 1e9; };
  if (!is_side(width) || !is_side(height)) {
    fail(file, "a PFM of " + words[1] + " x " + words[2] + " pixels, which cannot be decoded",
         "a whole width and height");
  }
  std::size_t pixels = 0;
  for (int word = 0; word < 4; ++word) pixels = bytes.find_first_of(kSpace, bytes.find_first_not_of(kSpace, pixels));
  ++pixels;  // one byte of space ends the header
  if (static_cast<double>(bytes.size()) != width * height * sizeof(float) + static_cast<double>(pixels)) {
    fail(file, std::to_string(bytes.size()) + " bytes", "a header and " + words[1] + " x " + words[2] + " floats");
  }
  return {static_cast<int>(width), static_cast<int>(height), scale > 0, pixels};
}

/// Position of a row, top row first, in a file whose rows run from the bottom up.
std::size_t row_position(int row, int width, int height) {
  return static_cast<std::size_t>(height - 1 - row) * static_cast<std::size_t>(width) * sizeof(float);
}

}  // namespace

FloatMap read_float_map(const std::string& file) {
  std::string bytes = read_bytes(file);
  const Header header = read_header(bytes, file);
  FloatMap map{header.width, header.height, {}};
  map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  if (header.big_endian) {
    for (std::size_t at = header.pixels; at + sizeof(float) <= bytes.size(); at += sizeof(float))
      std::reverse(bytes.data() + at, bytes.data() + at + sizeof(float));
  }
  for (int y = 0; y < map.height; ++y) {
    std::memcpy(map.values.data() + static_cast<std::ptrdiff_t>(y) * map.width,
                bytes.data() + header.pixels + row_position(y, map.width, map.height),
                static_cast<std::size_t>(map.width) * sizeof(float));
  }
  return map;
}

void write_float_map(const std::string& file, const FloatMap& map) {
  std::string bytes = "Pf\n" + std::to_string(map.width) + " " + std::to_string(map.height) + "\n-1\n";
  for (int y = map.height - 1; y >= 0; --y) {
    bytes.append(reinterpret_cast<const char*>(map.values.data() + static_cast<std::ptrdiff_t>(y) * map.width),
                 static_cast<std::size_t>(map.width) * sizeof(float));
  }
  write_atomically(file, bytes);
}

}  // namespace quadedge::data
