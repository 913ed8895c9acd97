/// \file edge_descriptions.cpp  Launches for patches, SIFT and wide descriptors; buffers grow with the edges.
#include "device/edge_descriptions.hpp"

#include "common/layouts.hpp"
#include "common/matching_constants.hpp"
#include "common/numeric.hpp"

namespace quadedge::stages {
namespace {

constexpr int kVector = 8;  // pixels per work-item of the maps

}  // namespace

Patches::Patches(opencl::Context& context, int width, int height, const PatchesConfig& config,
                 const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "patches", variants),
      width_(width),
      height_(height),
      offset_(static_cast<float>(config.offset)),
      corners_(context, max_value),
      unused_(context, 1) {
  kernel_ = {context, variant_.program(context, image_defines(max_value)), "side_patches"};
}

void Patches::prepare(const opencl::Buffer<cl_uchar>& image) {
  begin();
  corners_.prepare(image, width_, height_);
}

void Patches::cut(const PositionsView& edges, opencl::Buffer<cl_char>& patches) { cut(edges, true, unused_, patches); }

void Patches::cut(const PositionsView& edges, const opencl::Buffer<cl_int>& wanted, opencl::Buffer<cl_char>& patches) {
  cut(edges, false, wanted, patches);
}

void Patches::cut(const PositionsView& edges, bool all, const opencl::Buffer<cl_int>& wanted,
                  opencl::Buffer<cl_char>& patches) {
  begin();
  const auto count = static_cast<std::size_t>(edges.at.count);
  patches.ensure(context_, count * kEdgePatchBytes);
  kernel_(over(count, kPatchItems), {width_, height_, offset_, all ? 1 : 0, edges.at}, corners_.values(), edges.packed,
          wanted, patches);
}

Sift::Sift(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "sift", variants),
      width_(width),
      height_(height),
      stride_(round_up(width, kVector) + 2 * kSiftPadding),
      offset_(static_cast<float>(kSiftOffset)) {
  const auto program = variant_.program(context, image_defines(max_value));
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
  begin();
  if (magnitude_.capacity() == 0) reserve_planes();
  const std::size_t group = 16;
  blur_down_({(stride - 2 * kSiftPadding) / kVector + 2, height, group, 1}, image, width_, height_, stride_,
             blurred_down_);
  blur_along_({(stride - 2 * kSiftPadding) / kVector, height, group, 1}, blurred_down_, height_, stride_, blurred_);
  gradient_({stride / kVector, height + 2 * kSiftPadding, group, 1}, blurred_, width_, height_, stride_, magnitude_,
            angle_);
}

void Sift::describe(const PositionsView& edges, opencl::Buffer<cl_uchar>& descriptors) {
  begin();
  const auto count = static_cast<std::size_t>(edges.at.count);
  descriptors.ensure(context_, count * kEdgeSiftBytes);
  describe_(over(count, kSiftItems), {width_, height_, stride_, offset_, edges.at}, magnitude_, angle_, edges.packed,
            descriptors);
}

WideDescription::WideDescription(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
                                 int max_value)
    : Stage(context, "wide_description", variants),
      width_(width),
      small_width_(width / kWideShrink),
      small_height_(height / kWideShrink) {
  const auto program = variant_.program(context, image_defines(max_value));
  shrink_ = {context, program, "wide_shrink"};
  describe_ = {context, program, "wide_describe"};
}

void WideDescription::prepare(const opencl::Buffer<cl_uchar>& image, opencl::Buffer<cl_float>& small) {
  begin();
  const auto columns = static_cast<std::size_t>(small_width_), lines = static_cast<std::size_t>(small_height_);
  small.ensure(context_, columns * lines);
  shrink_({columns, lines, local_size_, 1}, image, width_, small_width_, small_height_, small);
}

int WideDescription::describe(const opencl::Buffer<cl_float>& small, const DeviceStereoEdges& edges, int step,
                              opencl::Buffer<cl_uchar>& descriptors) {
  begin();
  const int rows = (edges.count + step - 1) / step;
  descriptors.ensure(context_, static_cast<std::size_t>(rows) * kWideBytes);
  describe_(over(static_cast<std::size_t>(rows), kWideCells * kWideCells), small, small_width_, small_height_,
            edges.packed, edges.stride, rows, step, descriptors);
  return rows;
}

}  // namespace quadedge::stages
