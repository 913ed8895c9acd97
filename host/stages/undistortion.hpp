#pragma once
/// \file undistortion.hpp  Stage 1: converts the recorded image to a pinhole image on the device.

#include <map>
#include <optional>
#include <string>

#include "opencl/kernel.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"
#include "stages/pixel_corners.hpp"

namespace quadedge::stages {

/// Uploads the images of one camera and removes lens distortion; without a table it only uploads.
class Undistortion {
 public:
  /// `table` may be empty: the recorded images are pinhole images of width x height already. `max_value`: the largest
  /// value of their pixels.
  Undistortion(opencl::Context& context, const UndistortionTable& table, int width, int height,
               const std::map<std::string, std::string>& variants, int max_value = kMaxValue8);

  /// Enqueues upload and undistortion. `image` receives the packed pinhole image, height x width.
  /// The recorded image may have any size when there is a table.
  void run(const ImageView& recorded, opencl::Buffer<cl_uchar>& image);

 private:
  void upload(const ImageView& recorded, opencl::Buffer<cl_uchar>& target);

  opencl::Context& context_;
  std::size_t pixels_ = 0, bytes_per_pixel_;
  std::size_t local_size_ = 1;
  bool active_ = false;
  opencl::Buffer<cl_float> source_x_, source_y_;
  opencl::Buffer<cl_uchar> recorded_;
  std::optional<PixelCorners> corners_;  ///< of the recorded image
  opencl::Kernel<opencl::In<cl_uint>, cl_int, cl_int, opencl::In<cl_float>, opencl::In<cl_float>, opencl::Out<cl_uchar>,
                 cl_int>
      kernel_;
};

}  // namespace quadedge::stages
