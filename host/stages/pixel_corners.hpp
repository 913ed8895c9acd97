#pragma once
/// \file pixel_corners.hpp  An image prepared on the device for bilinear sampling: four grey levels packed per pixel.

#include "opencl/kernel.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// Holds the corners of one image, kernels/pixel_corners.cl, until the next one.
class PixelCorners {
 public:
  explicit PixelCorners(opencl::Context& context, int max_value = kMaxValue8);

  /// Enqueues the preparation of `image` (packed, height x width); part of the stage begun last.
  void prepare(const opencl::Buffer<cl_uchar>& image, int width, int height);

  /// height x width: (x, y), (x+1, y), (x, y+1), (x+1, y+1) from the lowest byte on, border replicated; two words per
  /// pixel where an image has more than 8 bits.
  const opencl::Buffer<cl_uint>& values() const { return values_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  opencl::Context* context_;
  std::size_t words_per_pixel_;
  opencl::Buffer<cl_uint> values_;
  int width_ = 0, height_ = 0;
  opencl::Kernel<opencl::In<cl_uchar>, cl_int, cl_int, opencl::Out<cl_uint>> kernel_;
};

}  // namespace quadedge::stages
