#include "data/split_views.hpp"

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

std::pair<Image, Image> split_views(const Image& both, Split split, const std::string& picture) {
  const bool beside = split == Split::left_right;
  if ((beside ? both.width : both.height) % 2 != 0)
    fail(picture, to_string({both.width, both.height}) + " pixels",
         beside ? "an even width to halve" : "an even height to halve");
  const int width = beside ? both.width / 2 : both.width, height = beside ? both.height : both.height / 2;
  return {part_of(both, 0, 0, width, height),
          beside ? part_of(both, width, 0, width, height) : part_of(both, 0, height, width, height)};
}

}  // namespace quadedge::data
