#include "stages/wide_description.hpp"

#include "common/layouts.hpp"
#include "opencl/variants.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {

WideDescription::WideDescription(opencl::Context& context, int width, int height,
                                 const std::map<std::string, std::string>& variants, int max_value)
    : context_(context), width_(width), small_width_(width / kWideShrink), small_height_(height / kWideShrink) {
  const auto& variant = opencl::choose_variant("wide_description", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_row_ = variant.form == opencl::Form::groups ? kWideCells * kWideCells : 1;
  const auto program = variant.program(context, image_defines(max_value));
  shrink_ = {context, program, "wide_shrink"};
  describe_ = {context, program, "wide_describe"};
}

void WideDescription::prepare(const opencl::Buffer<cl_uchar>& image, opencl::Buffer<cl_float>& small) {
  context_.begin_stage("wide_description");
  const auto columns = static_cast<std::size_t>(small_width_), lines = static_cast<std::size_t>(small_height_);
  small.ensure(context_, columns * lines);
  shrink_({columns, lines, local_size_, 1}, image, width_, small_width_, small_height_, small);
}

int WideDescription::describe(const opencl::Buffer<cl_float>& small, const DeviceStereoEdges& edges, int step,
                              opencl::Buffer<cl_uchar>& descriptors) {
  context_.begin_stage("wide_description");
  const int rows = (edges.count + step - 1) / step;
  descriptors.ensure(context_, static_cast<std::size_t>(rows) * kWideBytes);
  describe_({static_cast<std::size_t>(rows) * items_per_row_, local_size_}, small, small_width_, small_height_,
            edges.packed, edges.stride, rows, step, descriptors);
  return rows;
}

}  // namespace quadedge::stages
