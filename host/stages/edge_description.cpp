#include "stages/edge_description.hpp"

#include "common/layouts.hpp"
#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

constexpr int kPadding = 16;    // PAD of sift.cl
constexpr int kSiftVector = 8;  // pixels per work-item there

int round_up(int value, int step) { return (value + step - 1) / step * step; }

std::size_t items_per_edge(const opencl::Variant& variant) {
  return static_cast<std::size_t>(std::stoi(variant.defines.at("ITEMS_PER_EDGE")));
}

}  // namespace

EdgeDescription::EdgeDescription(opencl::Context& context, int width, int height, const PatchesConfig& patches,
                                 const SiftConfig& sift, const std::map<std::string, std::string>& variants)
    : context_(context),
      width_(width),
      height_(height),
      stride_(round_up(width, kSiftVector) + 2 * kPadding),
      patch_offset_(static_cast<float>(patches.offset)),
      sift_offset_(static_cast<float>(sift.offset)),
      corners_(context) {
  const auto& patches_variant = opencl::choose_variant("patches", context, variants);
  patches_local_ = static_cast<std::size_t>(patches_variant.local_size);
  patches_items_ = items_per_edge(patches_variant);
  const auto patches_program = context.program({"direction.cl", "photometric.cl", "photometric_lanes.cl", "patches.cl"},
                                               patches_variant.defines);
  patches_kernel_ = {context, patches_program, "side_patches"};

  const auto& sift_variant = opencl::choose_variant("sift", context, variants);
  sift_local_ = static_cast<std::size_t>(sift_variant.local_size);
  sift_items_ = items_per_edge(sift_variant);
  const auto sift_program = context.program({"direction.cl", "sift.cl"}, sift_variant.defines);
  blur_down_kernel_ = {context, sift_program, "sift_blur_down"};
  blur_along_kernel_ = {context, sift_program, "sift_blur_along"};
  gradient_kernel_ = {context, sift_program, "sift_gradient"};
  sift_kernel_ = {context, sift_program, "sift_describe"};
}

void EdgeDescription::prepare(const opencl::Buffer<cl_uchar>& image) {
  context_.begin_stage("patches");
  corners_.prepare(image, width_, height_);
}

void EdgeDescription::reserve_planes() {
  const std::size_t plane = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
  const std::size_t map = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 2 * kPadding);
  blurred_down_.ensure(context_, plane);
  blurred_.ensure(context_, plane);
  blurred_.fill(0.0f, plane);  // the columns beside the image are read and not used
  magnitude_.ensure(context_, map);
  angle_.ensure(context_, map);
}

void EdgeDescription::prepare_sift(const opencl::Buffer<cl_uchar>& image) {
  const auto height = static_cast<std::size_t>(height_);
  const auto stride = static_cast<std::size_t>(stride_);
  context_.begin_stage("sift");
  if (magnitude_.capacity() == 0) reserve_planes();
  const std::size_t group = 16;
  blur_down_kernel_({(stride - 2 * kPadding) / kSiftVector + 2, height, group, 1}, image, width_, height_, stride_,
                    blurred_down_);
  blur_along_kernel_({(stride - 2 * kPadding) / kSiftVector, height, group, 1}, blurred_down_, height_, stride_,
                     blurred_);
  gradient_kernel_({stride / kSiftVector, height + 2 * kPadding, group, 1}, blurred_, width_, height_, stride_,
                   magnitude_, angle_);
}

void EdgeDescription::cut_patches(const opencl::Buffer<cl_float>& x, const opencl::Buffer<cl_float>& y,
                                  const opencl::Buffer<cl_float>& direction, int count,
                                  opencl::Buffer<cl_char>& patches) {
  context_.begin_stage("patches");
  const auto edges = static_cast<std::size_t>(count);
  patches.ensure(context_, edges * kEdgePatchBytes);
  patches_kernel_({edges * patches_items_, patches_local_}, corners_.values(), width_, height_, x, y, direction, count,
                  patch_offset_, patches);
}

void EdgeDescription::describe_sift(const opencl::Buffer<cl_float>& x, const opencl::Buffer<cl_float>& y,
                                    const opencl::Buffer<cl_float>& direction, int count,
                                    opencl::Buffer<cl_uchar>& sift) {
  context_.begin_stage("sift");
  const auto edges = static_cast<std::size_t>(count);
  sift.ensure(context_, edges * kEdgeSiftBytes);
  sift_kernel_({edges * sift_items_, sift_local_}, magnitude_, angle_, width_, height_, stride_, x, y, direction, count,
               sift_offset_, sift);
}

}  // namespace quadedge::stages
