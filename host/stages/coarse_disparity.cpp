#include "stages/coarse_disparity.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {

CoarseDisparity::CoarseDisparity(opencl::Context& context, const std::map<std::string, std::string>& variants,
                                 int max_value)
    : context_(context) {
  const auto& variant = opencl::choose_variant("coarse_disparity", context, variants);
  items_per_row_ = static_cast<std::size_t>(variant.local_size);
  strip_ = std::stoi(variant.defines.at("COLUMNS"));
  const auto program = variant.program(context, image_defines(max_value));
  halve_ = {context, program, "coarse_halve"};
  planes_ = {context, program, "coarse_planes"};
  rows_ = {context, program, "coarse_rows"};
  columns_ = {context, program, "coarse_columns"};
  choose_ = {context, program, "coarse_positions"};
}

void CoarseDisparity::prepare(const DeviceImage& image, int height, const PlaneRows& rows,
                              opencl::Buffer<cl_uchar>& planes) {
  const auto lines = static_cast<std::size_t>(height);
  half_.ensure(context_, lines * static_cast<std::size_t>(rows.width));
  planes.ensure(context_, lines * kCoarsePlanes * static_cast<std::size_t>(rows.stride));
  const opencl::Range range(lines * items_per_row_, items_per_row_);
  halve_(range, image.pixels, image.width, rows.width, half_);
  planes_(range, half_, rows.width, height, rows.front, rows.stride, rows.mirrored ? 1 : 0, planes);
}

std::size_t CoarseDisparity::bytes(const CoarseDisparityArguments& search) {
  const auto width = static_cast<std::size_t>(search.width), stride = static_cast<std::size_t>(search.right_stride);
  const std::size_t volume = width * static_cast<std::size_t>(search.levels) * (sizeof(cl_uchar) + sizeof(cl_ushort));
  const std::size_t planes = (kCoarsePlanes + 1) * (width + stride);
  return static_cast<std::size_t>(search.height) *
         (volume + planes + stride * sizeof(cl_uint) + width * sizeof(cl_float));
}

void CoarseDisparity::run(const DeviceImage& left, const DeviceImage& right, const CoarseDisparityArguments& search) {
  context_.begin_stage("coarse_disparity");
  search_ = search;
  const auto lines = static_cast<std::size_t>(search.height), columns = static_cast<std::size_t>(search.width),
             cells = lines * columns * static_cast<std::size_t>(search.levels);
  prepare(left, search.height, {search.width, 0, search.width, false}, left_planes_);
  prepare(right, search.height, {search.right_width, search.right_front, search.right_stride, true}, right_planes_);
  costs_.ensure(context_, cells);
  sums_.ensure(context_, cells);
  lowest_.ensure(context_, lines * static_cast<std::size_t>(search.right_stride));
  positions_.ensure(context_, lines * columns);
  const auto strip = static_cast<std::size_t>(strip_);
  const opencl::Range range(lines * items_per_row_, items_per_row_);
  rows_(range, search, left_planes_, right_planes_, costs_, sums_);
  columns_({(columns + strip - 1) / strip * items_per_row_, items_per_row_}, search, costs_, sums_);
  choose_(range, search, sums_, lowest_, positions_);
}

}  // namespace quadedge::stages
