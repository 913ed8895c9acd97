#include "stages/edge_detection.hpp"

#include <algorithm>

#include "common/gaussian_taps.hpp"
#include "common/numeric.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kItemsPerUnit = 1024;  // that a compute unit runs at once in edges_tile_directions
constexpr int kStripRows = 32;               // that one work-item filters: two more are computed twice

}  // namespace

EdgeDetection::EdgeDetection(opencl::Context& context, int width, int height, const EdgesConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), width_(width), height_(height), config_(config), scan_(context, variants) {
  build(variants);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto capacity = static_cast<std::size_t>(config.max_edges);
  maxima_.at_pixels = !strips_;
  maxima_.winners.ensure(context, 4 * (pixels + kMaximaAtOnce));
  maxima_.counts.ensure(context, static_cast<std::size_t>(height));
  if (strips_) {
    line_ = kStripLineFront + round_up(width + 2 * kernel_radius(config.sigma) + 32, 16);
    const int strips = (height + kStripRows - 1) / kStripRows;
    scratch_.ensure(context,
                    static_cast<std::size_t>(strips) * kStripLines * static_cast<std::size_t>(line_) + kStripLineFront);
  } else {
    maxima_.flags.ensure(context, pixels);
    compact_.ensure(context, 4 * capacity);
    rows_.ensure(context, capacity);
  }
}

void EdgeDetection::build(const std::map<std::string, std::string>& variants) {
  const auto& variant = opencl::choose_variant("edge_detection", context_, variants);
  strips_ = variant.form == opencl::Form::items;
  local_size_ = static_cast<std::size_t>(variant.local_size);
  opencl::Defines defines = gradient_defines(config_);
  if (!strips_) defines["LOCAL"] = std::to_string(variant.local_size);
  const cl::Program program = variant.program(context_, defines);
  if (strips_) {
    strip_maxima_ = {context_, program, "edges_strip_maxima"};
    strip_directions_ = {context_, program, "edges_strip_directions"};
  } else {
    const int tile_x = std::stoi(variant.defines.at("TILE_X")), tile_y = std::stoi(variant.defines.at("TILE_Y"));
    tiles_x_ = (width_ + tile_x - 1) / tile_x;
    tiles_y_ = (height_ + tile_y - 1) / tile_y;
    tile_maxima_ = {context_, program, "edges_tile_maxima"};
    tile_count_ = {context_, program, "edges_tile_count"};
    tile_compact_ = {context_, program, "edges_tile_compact"};
    tile_directions_ = {context_, program, "edges_tile_directions"};
  }
}

DetectionArguments EdgeDetection::arguments(const PaddedPlane& plane) const {
  const double newton_max = config_.direction_at == "pixel" ? 0.0 : config_.newton_max;
  return {width_, height_, plane.stride(), config_.margin, static_cast<float>(newton_max), config_.max_edges};
}

void EdgeDetection::run(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold, DeviceEdges& edges) {
  find_maxima(plane, threshold);
  take_directions(plane, edges);
}

void EdgeDetection::find_maxima(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold) {
  context_.begin_stage("edge_detection");
  if (strips_) {
    find_maxima_in_strips(plane, threshold);
  } else {
    find_maxima_in_tiles(plane, threshold);
  }
}

void EdgeDetection::take_directions(const PaddedPlane& plane, DeviceEdges& edges) {
  context_.begin_stage("edge_detection");
  edges.reserve(context_, config_.max_edges);
  const DetectionArguments arguments = this->arguments(plane);
  const auto rows = static_cast<std::size_t>(height_);
  if (!strips_) tile_count_({rows * local_size_, local_size_}, maxima_.flags, width_, maxima_.counts);
  scan_.run(maxima_.counts, height_, config_.max_edges, edges.row_first, edges.count);
  if (strips_) {
    strip_directions_({rows, local_size_}, arguments, plane.pixels(), maxima_.winners, maxima_.counts, edges.row_first,
                      edges.packed);
  } else {
    tile_compact_({rows * local_size_, local_size_}, maxima_.flags, width_, maxima_.winners, edges.row_first,
                  config_.max_edges, compact_, rows_);
    const std::size_t at_most = 8 * static_cast<std::size_t>(config_.max_edges);
    tile_directions_({std::min(at_most, context_.limits().compute_units * kItemsPerUnit), local_size_}, arguments,
                     plane.pixels(), compact_, rows_, edges.count, edges.packed);
  }
}

void EdgeDetection::find_maxima_in_strips(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold) {
  const auto strips = static_cast<std::size_t>((height_ + kStripRows - 1) / kStripRows);
  strip_maxima_({strips, local_size_}, arguments(plane), threshold, kStripRows, plane.pixels(), plane.taps(), scratch_,
                line_, maxima_.winners, maxima_.counts);
}

void EdgeDetection::find_maxima_in_tiles(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold) {
  const auto tiles = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  tile_maxima_({tiles * local_size_, local_size_}, arguments(plane), threshold, tiles_x_, plane.pixels(), plane.taps(),
               maxima_.winners, maxima_.flags);
}

}  // namespace quadedge::stages
