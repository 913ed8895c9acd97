#include "stages/undistortion.hpp"

#include "opencl/variants.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {

Undistortion::Undistortion(opencl::Context& context, const UndistortionTable& table, int width, int height,
                           const std::map<std::string, std::string>& variants, int max_value)
    : context_(context),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      bytes_per_pixel_(bytes_per_pixel(max_value)),
      active_(!table.empty()) {
  if (!active_) return;
  const auto& variant = opencl::choose_variant("undistortion", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  kernel_ = {context, variant.program(context, image_defines(max_value)), "undistort"};
  corners_.emplace(context, max_value);
  source_x_.write(context, table.source_x);
  source_y_.write(context, table.source_y);
}

void Undistortion::upload(const ImageView& recorded, opencl::Buffer<cl_uchar>& target) {
  const auto width = static_cast<std::size_t>(recorded.width) * bytes_per_pixel_;
  const auto height = static_cast<std::size_t>(recorded.height);
  target.ensure(context_, width * height);
  context_.count_to_device(width * height);
  try {
    context_.queue().enqueueWriteBufferRect(target.memory(), CL_FALSE, {0, 0, 0}, {0, 0, 0}, {width, height, 1}, width,
                                            0, static_cast<std::size_t>(recorded.stride), 0, recorded.pixels, nullptr,
                                            context_.watch(opencl::Context::Command::transfer));
    context_.copy_started();
  } catch (const cl::Error& error) {
    opencl::throw_device_error("uploading an image", error.err(), context_.name());
  }
}

void Undistortion::run(const ImageView& recorded, opencl::Buffer<cl_uchar>& image) {
  context_.begin_stage("undistortion");
  if (!active_) {
    upload(recorded, image);
    return;
  }
  upload(recorded, recorded_);
  image.ensure(context_, pixels_ * bytes_per_pixel_);
  corners_->prepare(recorded_, recorded.width, recorded.height);
  kernel_({pixels_, local_size_}, corners_->values(), recorded.width, recorded.height, source_x_, source_y_, image,
          static_cast<cl_int>(pixels_));
}

}  // namespace quadedge::stages
