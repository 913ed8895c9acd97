#pragma once
/// \file images.hpp  Checks of the images passed to the library, and masks with a border.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
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
  /// The same for a frame. \throws DataError also for a mask that has not 8 bits or the size of its image.
  void check(const StereoFrame& frame) const {
    check(frame.left, frame.right);
    check_mask(frame.left_mask, frame.left, "the left mask");
    check_mask(frame.right_mask, frame.right, "the right mask");
  }

 private:
  struct Size {
    int width, height;  ///< 0: any
  };

  static void check_mask(const ImageView& mask, const ImageView& image, const std::string& name) {
    if (mask.pixels == nullptr) return;
    check_pixels(mask, name);
    if (mask.max_value != kMaxValue8)
      throw DataError(name + " has values up to " + std::to_string(mask.max_value) +
                      ", expected 8 bits: 0 where nothing is to be tracked");
    if (mask.width != image.width || mask.height != image.height)
      throw DataError(name + " has " + std::to_string(mask.width) + "x" + std::to_string(mask.height) +
                      " pixels, its image has " + std::to_string(image.width) + "x" + std::to_string(image.height));
  }
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

/// Replaces every byte by the OR of those at up to `window` - 1 units ahead, as far as there are any.
inline void or_ahead(std::vector<std::uint8_t>& bytes, std::size_t unit, std::size_t window) {
  for (std::size_t covered = 1; covered < window;) {
    const std::size_t ahead = std::min(covered, window - covered), shift = ahead * unit;
    std::uint8_t* to = bytes.data();
#pragma GCC ivdep
    for (std::size_t i = 0; i + shift < bytes.size(); ++i) to[i] |= to[i + shift];
    covered += ahead;
  }
}

/// A mask that also hides pixels up to `margin` pixels away along a row, a column, or both. This is the extent of an
/// edge's neighbourhood and equals the margin at the image border.
inline PixelMask with_border(const PixelMask& mask, int margin) {
  const auto width = static_cast<std::size_t>(mask.width), height = static_cast<std::size_t>(mask.height),
             border = static_cast<std::size_t>(margin), window = 2 * border + 1, padded = width + 2 * border;
  // With `margin` zeros before and after each row, and then as many rows of zeros above and below.
  std::vector<std::uint8_t> rows(height * padded, 0), columns((height + 2 * border) * width, 0);
  for (std::size_t y = 0; y < height; ++y)
    std::copy_n(mask.hidden.begin() + static_cast<std::ptrdiff_t>(y * width), width,
                rows.begin() + static_cast<std::ptrdiff_t>(y * padded + border));
  or_ahead(rows, 1, window);
  for (std::size_t y = 0; y < height; ++y)
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(y * padded), width,
                columns.begin() + static_cast<std::ptrdiff_t>((y + border) * width));
  or_ahead(columns, width, window);
  columns.resize(height * width);
  return {mask.width, mask.height, std::move(columns)};
}

}  // namespace quadedge
