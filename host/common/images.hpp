#pragma once
/// \file images.hpp  Checks of the images passed to the library, and masks with a border.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// \throws DataError for an empty image and for a stride smaller than a row; `name` identifies the image.
inline void check_pixels(const ImageView& image, const std::string& name) {
  if (image.empty()) throw DataError(name + " is empty");
  const auto row_bytes = static_cast<std::ptrdiff_t>(bytes_per_pixel(image.max_value)) * image.width;
  if (image.stride >= row_bytes) return;
  throw DataError(name + " has a stride of " + std::to_string(image.stride) + " bytes, expected at least the " +
                  std::to_string(row_bytes) + " of a row");
}

/// Image sizes that a rig expects: those of its cameras, or those that its undistortion tables specify.
class RecordedImages {
 public:
  explicit RecordedImages(const StereoRig& rig)
      : left_(size_of(rig.left, rig.left_undistortion)),
        right_(size_of(rig.right, rig.right_undistortion)),
        max_value_(rig.max_value) {}

  /// \throws DataError for an empty image, a stride smaller than a row, or a size or bit depth that differs from the
  /// rig's.
  void check(const ImageView& left, const ImageView& right) const {
    check(left, left_, "the left image");
    check(right, right_, "the right image");
  }

 private:
  struct Size {
    int width, height;  ///< 0: any
  };

  static Size size_of(const PinholeCamera& camera, const UndistortionTable& table) {
    return table.empty() ? Size{camera.width, camera.height} : Size{table.recorded_width, table.recorded_height};
  }
  void check(const ImageView& image, const Size& size, const std::string& name) const {
    check_pixels(image, name);
    if (image.max_value != max_value_)
      throw DataError(name + " has pixel values up to " + std::to_string(image.max_value) +
                      ", the rig expects values up to " + std::to_string(max_value_) +
                      ": state the camera's as max_value of the rig (4095 for 12 bits)");
    if (size.width > 0 && (image.width != size.width || image.height != size.height))
      throw DataError(name + " has " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                      " pixels, the calibration expects " + std::to_string(size.width) + "x" +
                      std::to_string(size.height));
    if (const int brightest = brightest_of(image); brightest > max_value_)
      throw DataError(name + " has a pixel of " + std::to_string(brightest) + ", the rig expects values up to " +
                      std::to_string(max_value_) + " (max_value)");
  }
  /// Largest value of 16-bit pixels that can exceed max_value; 0 for others.
  static int brightest_of(const ImageView& image) {
    std::uint16_t largest = 0;
    if (image.max_value <= kMaxValue8 || image.max_value == std::numeric_limits<std::uint16_t>::max()) return largest;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        std::uint16_t word = 0;
        std::memcpy(&word, image.pixels + y * image.stride + 2 * x, sizeof word);
        largest = std::max(largest, word);
      }
    }
    return largest;
  }

  Size left_, right_;
  int max_value_;
};

/// A mask that also hides pixels up to `margin` pixels away along a row, a column, or both. This is the extent of an
/// edge's neighbourhood and equals the margin at the image border.
inline PixelMask with_border(const PixelMask& mask, int margin) {
  const auto spread = [&](const std::vector<std::uint8_t>& from, int lines, int length, int line_step, int step) {
    std::vector<std::uint8_t> to(from.size());
    for (int line = 0; line < lines; ++line) {
      const auto at = [&](int i) { return static_cast<std::size_t>(line * line_step + i * step); };
      int last = -margin - 1;  // last hidden pixel so far; then, from the other end, the next one
      for (int i = 0; i < length; ++i) {
        if (from[at(i)] != 0) last = i;
        if (i - last <= margin) to[at(i)] = 1;
      }
      last = length + margin;
      for (int i = length - 1; i >= 0; --i) {
        if (from[at(i)] != 0) last = i;
        if (last - i <= margin) to[at(i)] = 1;
      }
    }
    return to;
  };
  const auto along_rows = spread(mask.hidden, mask.height, mask.width, mask.width, 1);
  return {mask.width, mask.height, spread(along_rows, mask.width, mask.height, 1, mask.width)};
}

}  // namespace quadedge
