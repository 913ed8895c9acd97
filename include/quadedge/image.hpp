#pragma once
/// \file image.hpp  8-bit grey images: an owner, a view, and the two views of a stereo frame.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadedge {

/// A view of a grey image that somebody else owns. height x width, row-major; the centre of the top-left pixel is (0,
/// 0).
struct ImageView {
  const std::uint8_t* pixels = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next, at least width

  std::uint8_t at(int x, int y) const { return pixels[y * stride + x]; }
  bool empty() const { return pixels == nullptr || width <= 0 || height <= 0; }
};

/// An owning grey image without row padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  ///< height x width, row-major

  Image() = default;
  Image(int width_, int height_)
      : width(width_), height(height_), pixels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  ImageView view() const { return {pixels.data(), width, height, width}; }
};

/// Two recorded grey images of one time. The views must stay valid during track().
struct StereoFrame {
  std::int64_t stamp_ns = 0;
  ImageView left, right;
};

}  // namespace quadedge
