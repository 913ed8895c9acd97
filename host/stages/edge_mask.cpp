#include "stages/edge_mask.hpp"

#include "common/mask_border.hpp"

namespace quadedge::stages {

EdgeMask::EdgeMask(opencl::Context& context, const PixelMask& mask, int margin, const EdgeMaxima& maxima)
    : context_(context), width_(mask.width), height_(mask.height), local_size_(context.is_cpu() ? 1 : 64) {
  if (mask.empty()) return;
  hidden_.write(context, with_border(mask, margin).hidden);
  const cl::Program program = context.program({"edge_mask.cl"}, maxima.defines());
  if (maxima.at_pixels) {
    pixels_ = {context, program, "edge_mask_pixels"};
  } else {
    rows_ = {context, program, "edge_mask_rows"};
  }
}

void EdgeMask::run(EdgeMaxima& maxima) {
  if (width_ == 0) return;
  context_.begin_stage("edge_mask");
  const auto rows = static_cast<std::size_t>(height_), columns = static_cast<std::size_t>(width_);
  if (maxima.at_pixels) {
    pixels_({rows * columns, local_size_}, width_ * height_, hidden_, maxima.flags);
  } else {
    rows_({rows, local_size_}, width_, height_, hidden_, maxima.winners, maxima.counts);
  }
}

}  // namespace quadedge::stages
