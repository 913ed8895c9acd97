#include "stages/sift.hpp"

#include "common/numeric.hpp"
#include "opencl/variants.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {
namespace {

constexpr int kVector = 8;  // pixels per work-item of the maps

}  // namespace

Sift::Sift(opencl::Context& context, int width, int height, const SiftConfig& config,
           const std::map<std::string, std::string>& variants, int max_value)
    : context_(context),
      width_(width),
      height_(height),
      stride_(round_up(width, kVector) + 2 * kSiftPadding),
      offset_(static_cast<float>(config.offset)) {
  const auto& variant = opencl::choose_variant("sift", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_edge_ = variant.form == opencl::Form::groups ? kSiftItems : 1;
  const auto program = variant.program(context, image_defines(max_value));
  blur_down_ = {context, program, "sift_blur_down"};
  blur_along_ = {context, program, "sift_blur_along"};
  gradient_ = {context, program, "sift_gradient"};
  describe_ = {context, program, "sift_describe"};
}

void Sift::reserve_planes() {
  const std::size_t plane = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
  const std::size_t map = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 2 * kSiftPadding);
  blurred_down_.ensure(context_, plane);
  blurred_.ensure(context_, plane);
  blurred_.fill(0.0f, plane);  // the columns beside the image are read and not used
  magnitude_.ensure(context_, map);
  angle_.ensure(context_, map);
}

void Sift::prepare(const opencl::Buffer<cl_uchar>& image) {
  const auto height = static_cast<std::size_t>(height_);
  const auto stride = static_cast<std::size_t>(stride_);
  context_.begin_stage("sift");
  if (magnitude_.capacity() == 0) reserve_planes();
  const std::size_t group = 16;
  blur_down_({(stride - 2 * kSiftPadding) / kVector + 2, height, group, 1}, image, width_, height_, stride_,
             blurred_down_);
  blur_along_({(stride - 2 * kSiftPadding) / kVector, height, group, 1}, blurred_down_, height_, stride_, blurred_);
  gradient_({stride / kVector, height + 2 * kSiftPadding, group, 1}, blurred_, width_, height_, stride_, magnitude_,
            angle_);
}

void Sift::describe(const PositionsView& edges, opencl::Buffer<cl_uchar>& descriptors) {
  context_.begin_stage("sift");
  const auto count = static_cast<std::size_t>(edges.at.count);
  descriptors.ensure(context_, count * kEdgeSiftBytes);
  describe_({count * items_per_edge_, local_size_}, {width_, height_, stride_, offset_, edges.at}, magnitude_, angle_,
            edges.packed, descriptors);
}

}  // namespace quadedge::stages
