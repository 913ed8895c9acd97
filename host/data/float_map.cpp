#include "data/float_map.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "data/atomic_file.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// Absolute scale in the header, whose sign gives the byte order. Header and length are checked here because OpenCV
/// prints to the console if it fails to decode a file.
double checked_scale(const std::string& file) {
  const std::string bytes = read_bytes(file);
  constexpr std::size_t kLongestHeader = 100;  // bytes
  const auto words = split(std::string_view(bytes).substr(0, kLongestHeader), " \t\r\n");
  if (words.size() < 4 || words[0] != "Pf") {
    fail(file, bytes.empty() ? "an empty file" : "bytes that start with " + in_quotes(bytes.substr(0, 8)),
         "\"Pf\", width, height and scale, then one float per pixel");
  }
  const double width = parse_number(words[1], file, 2, "width"), height = parse_number(words[2], file, 2, "height");
  // Each word of the header is followed by at least one byte.
  const std::size_t header = words[0].size() + words[1].size() + words[2].size() + words[3].size() + 4;
  if (static_cast<double>(bytes.size()) < width * height * sizeof(float) + static_cast<double>(header)) {
    fail(file, std::to_string(bytes.size()) + " bytes", "a header and " + words[1] + " x " + words[2] + " floats");
  }
  return std::abs(parse_number(words[3], file, 3, "scale, negative for little-endian"));
}

}  // namespace

FloatMap read_float_map(const std::string& file) {
  const double scale = checked_scale(file);
  std::string reason;
  cv::Mat map;
  try {
    map = cv::imread(file, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& problem) {
    reason = " (" + problem.err + ")";
  }
  if (map.type() != CV_32FC1 || map.empty()) {
    fail(file, "a PFM that cannot be decoded" + reason, "width, height, scale, and the corresponding number of floats");
  }
  // OpenCV divides by the scale, but published maps contain pixels or metres at any scale (Middlebury's own writer uses
  // 1/255).
  map *= scale;
  return {map.cols, map.rows, std::vector<float>(map.begin<float>(), map.end<float>())};
}

void write_float_map(const std::string& file, const FloatMap& map) {
  const cv::Mat pixels(map.height, map.width, CV_32F, const_cast<float*>(map.values.data()));
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".pfm", pixels, bytes)) fail(file, "a map that cannot be encoded", "one float per pixel");
  write_atomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace quadedge::data
