#pragma once
/// \file image.hpp  Grey images of 8 to 16 bits: an owning image, a view, and the two views of a stereo frame.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace quadedge {

constexpr int kMaxValue8 = 255;  ///< largest pixel value of an 8-bit image

/// Bytes per pixel of an image with largest value `max_value`.
constexpr std::size_t bytes_per_pixel(int max_value) { return max_value > kMaxValue8 ? 2 : 1; }

/// A non-owning view of a grey image, height x width, row-major; the centre of the top-left pixel is (0, 0). Pixels are
/// bytes, or 16-bit words in native byte order if `max_value` exceeds 255. At any bit depth, values 0 to max_value
/// correspond to grey levels 0 to 255, so that thresholds do not depend on the depth.
struct ImageView {
  const std::uint8_t* pixels = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;   ///< bytes from one row to the next, at least the bytes of a row's pixels
  int max_value = kMaxValue8;  ///< value of a saturated pixel: 255, 4095 for 12 bits, 65535 for 16 bits

  /// A view of 16-bit pixels. `stride` in pixels.
  static ImageView of_words(const std::uint16_t* words, int width, int height, std::ptrdiff_t stride, int max_value) {
    return {reinterpret_cast<const std::uint8_t*>(words), width, height, 2 * stride, max_value};
  }

  /// Stored value of a pixel, 0 to max_value.
  int value(int x, int y) const {
    if (max_value <= kMaxValue8) return pixels[y * stride + x];
    std::uint16_t word = 0;
    std::memcpy(&word, pixels + y * stride + 2 * x, sizeof word);
    return word;
  }
  /// Grey level of a pixel, 0 to 255; for 8-bit images the stored value.
  float at(int x, int y) const {
    const int stored = value(x, y);
    return max_value == kMaxValue8 ? static_cast<float>(stored)
                                   : static_cast<float>(stored) * (255.0F / static_cast<float>(max_value));
  }
  bool empty() const { return pixels == nullptr || width <= 0 || height <= 0; }
};

/// An owning grey image without row padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  ///< height x width, row-major, encoded as in ImageView
  int max_value = kMaxValue8;        ///< see ImageView

  Image() = default;
  Image(int width_, int height_, int max_value_ = kMaxValue8)
      : width(width_),
        height(height_),
        pixels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * bytes_per_pixel(max_value_)),
        max_value(max_value_) {}

  ImageView view() const {
    return {pixels.data(), width, height, static_cast<std::ptrdiff_t>(bytes_per_pixel(max_value)) * width, max_value};
  }
  std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  /// Stores a value from 0 to max_value.
  void set(int x, int y, int value) {
    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    const auto word = static_cast<std::uint16_t>(value);
    if (max_value <= kMaxValue8) {
      pixels[at] = static_cast<std::uint8_t>(value);
    } else {
      std::memcpy(pixels.data() + 2 * at, &word, sizeof word);
    }
  }
};

/// Converts an image to 8 bits for display; grey levels are rounded.
inline Image to_8_bits(const ImageView& image) {
  Image result(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) result.set(x, y, static_cast<int>(std::lround(image.at(x, y))));
  return result;
}

/// Two recorded grey images of the same time. The views must remain valid during track().
struct StereoFrame {
  std::int64_t stamp_ns = 0;
  ImageView left = {}, right = {};
  /// Masks of this frame, of 8 bits and of the size of their image: where one is 0, the image shows something that is
  /// not to be tracked (people, a gripper). No edges are found within edges.margin of it. Empty: everything counts.
  ImageView left_mask = {}, right_mask = {};
};

/// Two grey images of the same time, owned.
struct StereoPair {
  int number = 0;  ///< number of the pair in its stream, from 0
  std::int64_t stamp_ns = 0;
  Image left = {}, right = {};
  Image left_mask = {}, right_mask = {};  ///< see StereoFrame; empty: none
  /// Valid as long as the pair.
  StereoFrame view() const { return {stamp_ns, left.view(), right.view(), left_mask.view(), right_mask.view()}; }
};

/// Decodes a PNG, JPEG, PGM or PPM at its full bit depth, as read_grey_image() does; colour images are converted to
/// luminance. `name` identifies the image in error messages. \throws DataError for a truncated or undecodable image.
Image decode_grey_image(std::string_view bytes, const std::string& name);

}  // namespace quadedge
