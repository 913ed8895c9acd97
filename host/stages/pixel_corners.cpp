#include "stages/pixel_corners.hpp"

#include "stages/device_image.hpp"

namespace quadedge::stages {

PixelCorners::PixelCorners(opencl::Context& context, int max_value)
    : context_(&context),
      words_per_pixel_(bytes_per_pixel(max_value)),
      kernel_(context, context.program({"pixel_corners.cl"}, image_defines(max_value)), "pixel_corners") {}

void PixelCorners::prepare(const opencl::Buffer<cl_uchar>& image, int width, int height) {
  width_ = width;
  height_ = height;
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  values_.ensure(*context_, columns * rows * words_per_pixel_);
  kernel_({(columns + 15) / 16, rows, 16, 1}, image, width, height, values_);
}

}  // namespace quadedge::stages
