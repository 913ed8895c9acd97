/// \file images.cpp  Uploads images, resamples them from packed corners, smooths rows and columns, pads planes.
#include "device/images.hpp"

#include <algorithm>
#include <vector>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "quadedge/error.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kPadGroup = 32;  // work-items per group of the padding kernel

std::string float_literal(double value) { return printed("%#.9gf", value); }

/// Weights of the pairs at k and -k: those of G, then of G'.
std::vector<cl_float> pair_taps(double sigma) {
  const int radius = kernel_radius(sigma);
  std::vector<cl_float> taps;
  for (std::size_t order = 0; order < 2; ++order)
    for (int k = 0; k <= radius; ++k)
      taps.push_back(static_cast<cl_float>(gaussian_derivatives(-k, sigma)[order]));  // the pixel at k, from the centre
  return taps;
}

}  // namespace

PixelCorners::PixelCorners(opencl::Context& context, int max_value)
    : context_(&context),
      words_per_pixel_(bytes_per_pixel(max_value)),
      kernel_(context, opencl::joint_program(context, {"pixel_corners.cl"}, image_defines(max_value)),
              "pixel_corners") {}

void PixelCorners::prepare(const opencl::Buffer<cl_uchar>& image, int width, int height) {
  width_ = width;
  height_ = height;
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  values_.ensure(*context_, columns * rows * words_per_pixel_);
  kernel_({(columns + 15) / 16, rows, 16, 1}, image, width, height, values_);
}

opencl::Defines gradient_defines(const EdgesConfig& config) {
  return {{"RADIUS", std::to_string(kernel_radius(config.sigma))},
          {"SIGMA", float_literal(config.sigma)},
          {"AT_PIXEL", config.direction_at == "pixel" ? "1" : "0"}};
}

PaddedPlane::PaddedPlane(opencl::Context& context, int width, int height, double sigma, int max_value)
    : width_(width), height_(height), max_value_(max_value) {
  if (width < 1 || height < 1) throw UsageError("edge detection needs an image of at least 1 x 1 pixels");
  const int radius = kernel_radius(sigma);
  const int pad_x = 16 * ((radius + 18) / 16), pad_y = radius + 2;  // as in kernels/edge_detection.cl
  stride_ = pad_x + round_up(width + radius + 18, 16);
  rows_ = height + 2 * pad_y;
  pixels_.ensure(context, static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_));
  taps_.write(context, pair_taps(sigma));
  EdgesConfig config;
  config.sigma = sigma;
  pad_ = {context,
          context.program({"edge_detection.cl", "padded_plane.cl"}, image_defines(max_value, gradient_defines(config))),
          "edges_pad"};
}

void PaddedPlane::prepare(const opencl::Buffer<cl_uchar>& image) {
  pad_({static_cast<std::size_t>(stride_ / 16), static_cast<std::size_t>(rows_), kPadGroup, 1}, image, width_, height_,
       pixels_, stride_);
}

Undistortion::Undistortion(opencl::Context& context, const UndistortionTable& table, int width, int height,
                           const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "undistortion", variants),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      bytes_per_pixel_(bytes_per_pixel(max_value)),
      max_value_(max_value),
      active_(!table.empty()) {
  if (!active_) return;
  const auto at_once = variant_.defines.find("PIXELS");
  const std::size_t pixels = at_once == variant_.defines.end() ? 1 : std::stoul(at_once->second);
  items_ = (pixels_ + pixels - 1) / pixels;
  kernel_ = {context, variant_.program(context, image_defines(max_value)), "undistort"};
  corners_.emplace(context, max_value);
  source_x_.write(context, table.source_x.values());
  source_y_.write(context, table.source_y.values());
}

void Undistortion::upload(const ImageView& recorded, opencl::Buffer<cl_uchar>& target) {
  const auto width = static_cast<std::size_t>(recorded.width) * bytes_per_pixel_;
  const auto height = static_cast<std::size_t>(recorded.height);
  target.ensure(context_, width * height);
  const auto stride = static_cast<std::size_t>(recorded.stride);
  try {
    if (!context_.is_cpu()) {
      auto* const copied = static_cast<cl_uchar*>(copied_.reserve(context_, width * height));
      for (std::size_t y = 0; y < height; ++y) std::copy_n(recorded.pixels + y * stride, width, copied + y * width);
      target.write_later(copied, width * height);
      return;
    }
    context_.count_to_device(width * height);
    context_.queue().enqueueWriteBufferRect(target.memory(), CL_FALSE, {0, 0, 0}, {0, 0, 0}, {width, height, 1}, width,
                                            0, stride, 0, recorded.pixels, nullptr,
                                            context_.watch(opencl::Context::Command::transfer));
    context_.copy_started();
  } catch (const cl::Error& error) {
    opencl::throw_device_error("uploading an image", error.err(), context_.name());
  }
}

void Undistortion::run(const ImageView& recorded, opencl::Buffer<cl_uchar>& image) {
  begin();
  recorded_width_ = recorded.width;
  recorded_height_ = recorded.height;
  upload(recorded, active_ ? recorded_ : image);
  if (active_) undistort(image);
}

void Undistortion::undistort(opencl::Buffer<cl_uchar>& image) {
  image.ensure(context_, pixels_ * bytes_per_pixel_);
  corners_->prepare(recorded_, recorded_width_, recorded_height_);
  kernel_(over(items_), corners_->values(), recorded_width_, recorded_height_, source_x_, source_y_, image,
          static_cast<cl_int>(pixels_));
}

void Undistortion::smooth(Smoothing& smoothing, opencl::Buffer<cl_uchar>& image, Image& recorded) {
  opencl::Buffer<cl_uchar>& pixels = active_ ? recorded_ : image;
  smoothing.run(recorded_width_, recorded_height_, pixels);
  recorded = Image(recorded_width_, recorded_height_, max_value_);
  recorded.pixels = pixels.read(recorded.pixels.size());
  begin();
  if (active_) undistort(image);
}

Smoothing::Smoothing(opencl::Context& context, const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "smoothing", variants) {
  const cl::Program program = variant_.program(context, image_defines(max_value));
  rows_ = {context, program, "smooth_rows"};
  columns_ = {context, program, "smooth_columns"};
}

void Smoothing::run(int width, int height, opencl::Buffer<cl_uchar>& image) {
  begin();
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  sums_.ensure(context_, columns * rows);
  const opencl::Range pixels{columns, rows, local_size_, 1};
  rows_(pixels, image, width, height, sums_);
  columns_(pixels, sums_, width, height, image);
}

}  // namespace quadedge::stages
