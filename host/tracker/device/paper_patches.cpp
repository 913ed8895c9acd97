/// \file paper_patches.cpp  Launches over pixels and edges; the picture's memory is allocated with the first image.
#include "device/paper_patches.hpp"

namespace quadedge::stages {

PaperPatches::PaperPatches(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
                           int max_value)
    : Stage(context, "paper_patches", variants), words_per_record_(2 * bytes_per_pixel(max_value)) {
  picture_.width = width;
  picture_.height = height;
  const auto program = variant_.program(context, image_defines(max_value));
  prepare_ = {context, program, "paper_picture"};
  cut_ = {context, program, "paper_patches"};
}

void PaperPatches::prepare(const opencl::Buffer<cl_uchar>& image) {
  begin();
  const auto columns = static_cast<std::size_t>(picture_.width) + 1, rows = static_cast<std::size_t>(picture_.height);
  picture_.records.ensure(context_, columns * rows * words_per_record_);
  prepare_({columns, rows, local_size_, 1}, image, picture_.width, picture_.height, picture_.records);
}

void PaperPatches::cut(const PositionsView& edges, double offset, opencl::Buffer<cl_float>& patches) {
  begin();
  const auto count = static_cast<std::size_t>(edges.at.count);
  patches.ensure(context_, count * kPaperPatchFloats);
  if (count == 0) return;
  cut_(over(count), {picture_.width, picture_.height, static_cast<float>(offset), 1, edges.at}, picture_.records,
       edges.packed, patches);
}

}  // namespace quadedge::stages
