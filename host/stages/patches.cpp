#include "stages/patches.hpp"

#include "opencl/variants.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {

Patches::Patches(opencl::Context& context, int width, int height, const PatchesConfig& config,
                 const std::map<std::string, std::string>& variants, int max_value)
    : context_(context),
      width_(width),
      height_(height),
      offset_(static_cast<float>(config.offset)),
      corners_(context, max_value),
      unused_(context, 1) {
  const auto& variant = opencl::choose_variant("patches", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_edge_ = variant.form == opencl::Form::groups ? kPatchItems : 1;
  kernel_ = {context, variant.program(context, image_defines(max_value)), "side_patches"};
}

void Patches::prepare(const opencl::Buffer<cl_uchar>& image) {
  context_.begin_stage("patches");
  corners_.prepare(image, width_, height_);
}

void Patches::cut(const PositionsView& edges, opencl::Buffer<cl_char>& patches) { cut(edges, true, unused_, patches); }

void Patches::cut(const PositionsView& edges, const opencl::Buffer<cl_int>& wanted, opencl::Buffer<cl_char>& patches) {
  cut(edges, false, wanted, patches);
}

void Patches::cut(const PositionsView& edges, bool all, const opencl::Buffer<cl_int>& wanted,
                  opencl::Buffer<cl_char>& patches) {
  context_.begin_stage("patches");
  const auto count = static_cast<std::size_t>(edges.at.count);
  patches.ensure(context_, count * kEdgePatchBytes);
  kernel_({count * items_per_edge_, local_size_}, {width_, height_, offset_, all ? 1 : 0, edges.at}, corners_.values(),
          edges.packed, wanted, patches);
}

}  // namespace quadedge::stages
