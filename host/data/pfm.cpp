#include "data/pfm.hpp"

#include <cstring>

#include "data/atomic_file.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

bool host_is_little_endian() {
  const std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

float swapped(float value) {
  unsigned char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  std::swap(bytes[0], bytes[3]);
  std::swap(bytes[1], bytes[2]);
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

FloatImage read_pfm(const std::string& file) {
  const std::string bytes = read_bytes(file);
  // Four words - "Pf", width, height, scale - and one white-space byte before the pixels.
  std::string words[4];
  std::size_t at = 0;
  for (auto& word : words) {
    at = bytes.find_first_not_of(" \t\r\n", at);
    const std::size_t end = at == std::string::npos ? std::string::npos : bytes.find_first_of(" \t\r\n", at);
    if (end == std::string::npos || end - at > 32) fail(file, "no PFM header", "Pf, width, height and scale");
    word = bytes.substr(at, end - at);
    at = end;
  }
  if (words[0] != "Pf") fail(file, in_quotes(words[0]), "\"Pf\", one float per pixel");
  const double width = parse_number(words[1], file, 2, "width"), height = parse_number(words[2], file, 2, "height");
  const bool little_endian = parse_number(words[3], file, 3, "scale, negative for little-endian") < 0;
  constexpr double kLargest = 65536;
  if (!(width >= 1 && width <= kLargest && height >= 1 && height <= kLargest)) {
    fail(file, words[1] + " x " + words[2] + " pixels", "sides between 1 and 65536");
  }
  FloatImage image{static_cast<int>(width), static_cast<int>(height), {}};
  const std::size_t row = static_cast<std::size_t>(image.width), rows = static_cast<std::size_t>(image.height);
  if (bytes.size() - at - 1 < row * rows * sizeof(float)) {
    fail(file, std::to_string(bytes.size() - at - 1) + " bytes of pixels", std::to_string(row * rows * sizeof(float)));
  }
  image.values.resize(row * rows);
  for (std::size_t y = 0; y < rows; ++y) {
    std::memcpy(&image.values[(rows - 1 - y) * row], bytes.data() + at + 1 + y * row * sizeof(float),
                row * sizeof(float));
  }
  if (little_endian != host_is_little_endian()) {
    for (float& value : image.values) value = swapped(value);
  }
  return image;
}

void write_pfm(const std::string& file, const FloatImage& image) {
  std::string bytes = "Pf\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
  const std::size_t row = static_cast<std::size_t>(image.width), start = bytes.size();
  bytes.resize(start + image.values.size() * sizeof(float));
  char* target = bytes.data() + start;
  for (int y = image.height - 1; y >= 0; --y) {
    for (std::size_t x = 0; x < row; ++x, target += sizeof(float)) {
      const float value = image.values[static_cast<std::size_t>(y) * row + x];
      const float stored = host_is_little_endian() ? value : swapped(value);
      std::memcpy(target, &stored, sizeof stored);
    }
  }
  write_atomically(file, bytes);
}

}  // namespace quadedge::data
