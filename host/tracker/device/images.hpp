#pragma once
/// \file images.hpp  Stage 1, and images on the device as the other stages read them: padded for filters, with
/// corners for bilinear sampling.

#include <optional>

#include "device/buffer.hpp"
#include "device/stage.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// `others` and the defines of programs that read images with values up to `max_value`.
inline opencl::Defines image_defines(int max_value, opencl::Defines others = {}) {
  if (max_value != kMaxValue8) others["MAX_VALUE"] = std::to_string(max_value);
  return others;
}

/// Packed, height x width, pixels as in ImageView.
struct DeviceImage {
  opencl::Buffer<cl_uchar> pixels;
  int width = 0, height = 0;
};

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
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int height, cl_uint* corners)> kernel_;
};

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
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int height, cl_float* plane, cl_int stride)> pad_;
};

/// The defines of every program that begins with edge_detection.cl.
opencl::Defines gradient_defines(const EdgesConfig& config);

/// Smooths noisy images, one after another.
class Smoothing : private Stage {
 public:
  Smoothing(opencl::Context& context, const opencl::VariantChoice& variants, int max_value = kMaxValue8);

  /// Enqueues the smoothing of `image` (packed, height x width), which is replaced.
  void run(int width, int height, opencl::Buffer<cl_uchar>& image);

 private:
  opencl::Buffer<cl_uint> sums_;
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int height, cl_uint* sums)> rows_;
  opencl::Kernel<void(const cl_uint* sums, cl_int width, cl_int height, cl_uchar* bytes)> columns_;
};

/// Stage 1: converts the recorded image to a pinhole image.
/// Uploads the images of one camera and removes lens distortion; without a table it only uploads.
class Undistortion : private Stage {
 public:
  /// `table` may be empty: the recorded images are pinhole images of width x height already. `max_value`: the largest
  /// value of their pixels.
  Undistortion(opencl::Context& context, const UndistortionTable& table, int width, int height,
               const opencl::VariantChoice& variants, int max_value = kMaxValue8);

  /// Enqueues upload and undistortion. `image` receives the packed pinhole image, height x width.
  /// The recorded image may have any size when there is a table.
  void run(const ImageView& recorded, opencl::Buffer<cl_uchar>& image);
  /// Smooths the recorded image on the device, which `recorded` receives, and undistorts it again. \param image as
  /// run() has left it
  void smooth(Smoothing& smoothing, opencl::Buffer<cl_uchar>& image, Image& recorded);

 private:
  void undistort(opencl::Buffer<cl_uchar>& image);
  void upload(const ImageView& recorded, opencl::Buffer<cl_uchar>& target);

  std::size_t pixels_ = 0, items_ = 0, bytes_per_pixel_;
  int max_value_, recorded_width_ = 0, recorded_height_ = 0;
  bool active_ = false;
  opencl::Buffer<cl_float> source_x_, source_y_;
  opencl::Buffer<cl_uchar> recorded_;
  opencl::PinnedMemory copied_;          ///< the recorded image on its way to a device that is no CPU
  std::optional<PixelCorners> corners_;  ///< of the recorded image
  opencl::Kernel<void(const cl_uint* corners, cl_int source_width, cl_int source_height, const cl_float* source_x,
                      const cl_float* source_y, cl_uchar* image, cl_int count)>
      kernel_;
};

}  // namespace quadedge::stages
