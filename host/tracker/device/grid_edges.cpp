/// \file grid_edges.cpp  Strips of grid rows per work-item, then the edges of each pixel row in order.
#include "device/grid_edges.hpp"

#include <string>
#include <vector>

#include "common/images.hpp"
#include "common/numeric.hpp"

namespace quadedge::stages {
namespace {

/// The weights as kernels/grid_edges.cl describes them.
std::vector<cl_float> grid_taps(double sigma) {
  const int radius = kernel_radius(sigma), window = round_up(2 * radius + 2, 8);
  std::vector<cl_float> taps;
  const auto add = [&](int pixel, int phase, std::size_t order, double share) {
    taps.push_back(static_cast<cl_float>(share * gaussian_derivatives(0.5 * phase - pixel, sigma)[order]));
  };
  for (int phase = 0; phase < 2; ++phase)
    for (std::size_t order = 0; order < 4; ++order)
      for (int j = 0; j <= radius; ++j) add(j + phase, phase, order, j + phase == 0 ? 0.5 : 1.0);  // a pair with itself
  for (int phase = 0; phase < 2; ++phase)
    for (std::size_t order = 0; order < 4; ++order)
      for (int k = 0; k < window; ++k) add(k - radius, phase, order, k <= 2 * radius + phase ? 1.0 : 0.0);
  return taps;
}

}  // namespace

GridEdges::GridEdges(opencl::Context& context, int width, int height, const EdgesConfig& config, const PixelMask& mask,
                     const opencl::VariantChoice& variants)
    : Stage(context, "grid_edges", variants),
      width_(width),
      height_(height),
      config_(config),
      strip_rows_(std::stoi(variant_.defines.at("STRIP_ROWS"))),
      line_(kStripLineFront + round_up(width + 3 * kernel_radius(config.sigma) + 48, 16)),
      scan_(context, variants) {
  const cl::Program program = variant_.program(context, gradient_defines(config));
  strips_ = {context, program, "grid_edges_strips"};
  count_ = {context, program, "grid_edges_count"};
  merge_ = {context, program, "grid_edges_merge"};
  taps_.write(context, grid_taps(config.sigma));
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  const std::size_t floats = strips() * kGridLines * static_cast<std::size_t>(line_) + kStripLineFront;
  scratch_.ensure(context, floats);
  scratch_.fill(0.0F, floats);
  found_.ensure(context, 16 * columns * rows);
  counts_.ensure(context, 4 * rows);
  of_rows_.ensure(context, rows);
  set_mask(mask);
}

void GridEdges::set_mask(const PixelMask& mask) {
  masked_ = !mask.empty();
  hidden_.write(context_, masked_ ? with_border(mask, config_.margin).hidden : std::vector<std::uint8_t>(1));
}

void GridEdges::run(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold, DeviceEdges& edges) {
  begin();
  edges.reserve(context_, config_.max_edges);
  const DetectionArguments arguments{width_, height_, plane.stride(), config_.margin, 0.0F, config_.max_edges};
  const auto rows = static_cast<std::size_t>(height_);
  strips_(over(strips()), arguments, threshold, plane.pixels(), taps_, hidden_, masked_ ? 1 : 0, scratch_, line_,
          found_, counts_);
  count_(over(rows), height_, counts_, of_rows_);
  scan_.run(of_rows_, height_, config_.max_edges, edges.row_first, edges.count);
  merge_(over(rows), arguments, found_, counts_, edges.row_first, edges.packed);
}

}  // namespace quadedge::stages
