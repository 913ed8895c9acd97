#pragma once
/// \file padded_plane.hpp  An image on the device as floats, ready for Gaussian derivatives.

#include "opencl/kernel.hpp"
#include "quadedge/config.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {

/// The plane and the taps of kernels/edge_detection.cl. One object per camera: it holds the image for all stages that
/// use its gradient.
class PaddedPlane {
 public:
  /// For images of width x height pixels with values to `max_value`. \throws UsageError for an empty one.
  PaddedPlane(opencl::Context& context, int width, int height, double sigma, int max_value = kMaxValue8);

  /// Enqueues the padding of `image` (packed, height x width); part of the stage begun last.
  void prepare(const opencl::Buffer<cl_uchar>& image);

  int width() const { return width_; }
  int height() const { return height_; }
  int stride() const { return stride_; }        ///< floats per row
  int max_value() const { return max_value_; }  ///< largest value of the image's pixels
  const opencl::Buffer<cl_float>& pixels() const { return pixels_; }
  const opencl::Buffer<cl_float>& taps() const { return taps_; }

 private:
  int width_, height_, max_value_, stride_, rows_;
  opencl::Buffer<cl_float> pixels_, taps_;
  opencl::Kernel<opencl::In<cl_uchar>, cl_int, cl_int, opencl::Out<cl_float>, cl_int> pad_;
};

/// The defines of every program that begins with edge_detection.cl.
opencl::Defines gradient_defines(const EdgesConfig& config);

}  // namespace quadedge::stages
