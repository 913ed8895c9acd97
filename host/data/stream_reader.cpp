#include "data/stream_reader.hpp"

#include <cmath>
#include <cstring>

#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

/// The part of an image that starts at a pixel.
Image part_of(const Image& whole, int x, int y, int width, int height) {
  Image part(width, height, whole.max_value);
  const std::size_t pixel = bytes_per_pixel(whole.max_value), row = pixel * static_cast<std::size_t>(width);
  for (int i = 0; i < height; ++i) {
    const std::size_t from =
        static_cast<std::size_t>(y + i) * static_cast<std::size_t>(whole.width) + static_cast<std::size_t>(x);
    std::memcpy(part.pixels.data() + static_cast<std::size_t>(i) * row, whole.pixels.data() + from * pixel, row);
  }
  return part;
}

}  // namespace

Split parse_split(const std::string& word) {
  if (word.empty()) return Split::none;
  if (word == "left-right") return Split::left_right;
  if (word == "top-bottom") return Split::top_bottom;
  throw UsageError("--split " + word + ": expected left-right or top-bottom");
}

std::optional<StereoPair> StreamReader::next() {
  const std::size_t stamps = options_.stamps_ns.size();
  while (options_.last < 0 || number_ < options_.last) {
    auto pair = first_ ? std::exchange(first_, std::nullopt) : read();
    const auto number = static_cast<std::size_t>(number_);
    if (stamps > 0 && !stopped_ && (pair ? number >= stamps : number < stamps))
      fail(options_.stamps_from, counted(stamps, "time"),
           pair ? "one for every pair" : std::to_string(number) + ", one for every pair");
    if (!pair) break;
    if (options_.fps > 0) pair->stamp_ns = std::llround(number_ / options_.fps * 1e9);
    if (stamps > 0) pair->stamp_ns = options_.stamps_ns[number];
    pair->number = number_++ - options_.first;
    if (pair->number >= 0) return pair;
  }
  return std::nullopt;
}

StereoPair StreamReader::halves(const Image& both, const std::string& picture) const {
  const bool beside = options_.split == Split::left_right;
  if ((beside ? both.width : both.height) % 2 != 0)
    fail(picture, to_string({both.width, both.height}) + " pixels",
         beside ? "an even width to halve" : "an even height to halve");
  const int width = beside ? both.width / 2 : both.width, height = beside ? both.height : both.height / 2;
  return {0, 0, part_of(both, 0, 0, width, height),
          part_of(both, both.width - width, both.height - height, width, height)};
}

StereoPair StreamOfReaders::look(const std::string& stream) {
  begun_ = make_();
  const auto& first = begun_->look();
  if (!first) fail(stream, "no image", "stereo pairs");
  return *first;
}

}  // namespace quadedge::data
