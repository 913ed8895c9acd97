/// \file edge_detection.cpp  Launches in one of two forms: strips of rows per work-item, tiles per work-group.
#include "device/edge_detection.hpp"

#include <algorithm>
#include <utility>

#include "common/filter_limits.hpp"
#include "common/images.hpp"
#include "common/numeric.hpp"
#include "quadedge/error.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kItemsPerUnit = 1024;  // that a compute unit runs at once in edges_tile_directions
constexpr int kStripRows = 32;               // that one work-item filters: two more are computed twice

}  // namespace

EdgeThreshold::EdgeThreshold(opencl::Context& context, const EdgesConfig& config, const opencl::VariantChoice& variants)
    : Stage(context, "edge_threshold", variants), config_(config) {
  values_.write(context, {static_cast<cl_float>(config.threshold), 0.0F, 0.0F});
  if (config.threshold > 0) return;
  opencl::Defines defines = gradient_defines(config);
  if (is_grouped()) defines["GROUP"] = std::to_string(variant_.local_size);
  const cl::Program program = variant_.program(context, defines);
  tally_ = {context, program, "edges_tally"};
  choose_ = {context, program, "edges_threshold"};
}

ThresholdArguments EdgeThreshold::arguments(const PaddedPlane& plane) const {
  const ThresholdLimits limits = threshold_limits(config_);
  const double step = kMaxGrey / plane.max_value();  // [grey levels]
  const auto value = [](double number) { return static_cast<float>(number); };
  return {plane.width(),       plane.height(),        plane.stride(),          value(kMaxGrey),
          value(step),         value(kThresholdArea), value(limits.per_noise), value(limits.per_step * step),
          value(kThresholdMax)};
}

int EdgeThreshold::tally(const PaddedPlane& plane, int first) {
  const int rows = plane.height() / kThresholdStep;
  tally_(over(static_cast<std::size_t>(rows), local_size_), arguments(plane), plane.pixels(), plane.taps(), first,
         tallies_);
  return rows;
}

void EdgeThreshold::run(const PaddedPlane& left, const PaddedPlane* right, float known_noise) {
  if (config_.threshold > 0) return;
  begin();
  const int rows = (left.height() + (right != nullptr ? right->height() : 0)) / kThresholdStep + 1;
  tallies_.ensure(context_, static_cast<std::size_t>(rows) * kThresholdBins);
  int count = tally(left, 0);
  if (right != nullptr) count += tally(*right, count);
  choose_({local_size_, local_size_}, arguments(left), tallies_, count, known_noise, values_);
}

EdgeDetection::EdgeDetection(opencl::Context& context, int width, int height, const EdgesConfig& config,
                             const opencl::VariantChoice& variants)
    : Stage(context, "edge_detection", variants),
      width_(width),
      height_(height),
      config_(config),
      scan_(context, variants) {
  build();
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto capacity = static_cast<std::size_t>(config.max_edges);
  maxima_.at_pixels = is_grouped();
  maxima_.winners.ensure(context, 4 * (pixels + kMaximaAtOnce));
  maxima_.counts.ensure(context, static_cast<std::size_t>(height));
  if (!is_grouped()) {
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

void EdgeDetection::build() {
  opencl::Defines defines = gradient_defines(config_);
  if (is_grouped()) defines["LOCAL"] = std::to_string(variant_.local_size);
  const cl::Program program = variant_.program(context_, defines);
  if (!is_grouped()) {
    strip_maxima_ = {context_, program, "edges_strip_maxima"};
    strip_directions_ = {context_, program, "edges_strip_directions"};
  } else {
    const int tile_x = std::stoi(variant_.defines.at("TILE_X")), tile_y = std::stoi(variant_.defines.at("TILE_Y"));
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
  begin();
  if (is_grouped()) {
    const auto tiles = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
    tile_maxima_(over(tiles, local_size_), arguments(plane), threshold, tiles_x_, plane.pixels(), plane.taps(),
                 maxima_.winners, maxima_.flags);
  } else {
    const auto strips = static_cast<std::size_t>((height_ + kStripRows - 1) / kStripRows);
    strip_maxima_(over(strips), arguments(plane), threshold, kStripRows, plane.pixels(), plane.taps(), scratch_, line_,
                  maxima_.winners, maxima_.counts);
  }
}

void EdgeDetection::take_directions(const PaddedPlane& plane, DeviceEdges& edges) {
  begin();
  edges.reserve(context_, config_.max_edges);
  const DetectionArguments arguments = this->arguments(plane);
  const opencl::Range rows = over(static_cast<std::size_t>(height_), local_size_);
  if (is_grouped()) tile_count_(rows, maxima_.flags, width_, maxima_.counts);
  scan_.run(maxima_.counts, height_, config_.max_edges, edges.row_first, edges.count);
  if (!is_grouped()) {
    strip_directions_(rows, arguments, plane.pixels(), maxima_.winners, maxima_.counts, edges.row_first, edges.packed);
  } else {
    tile_compact_(rows, maxima_.flags, width_, maxima_.winners, edges.row_first, config_.max_edges, compact_, rows_);
    const std::size_t at_most = 8 * static_cast<std::size_t>(config_.max_edges);
    tile_directions_({std::min(at_most, context_.limits().compute_units * kItemsPerUnit), local_size_}, arguments,
                     plane.pixels(), compact_, rows_, edges.count, edges.packed);
  }
}

EdgeMask::EdgeMask(opencl::Context& context, const PixelMask& mask, int margin, const EdgeMaxima& maxima)
    : context_(context), local_size_(context.is_cpu() ? 1 : 64) {
  // Also without a mask, as one that is found in mid-run should not delay that frame.
  if (maxima.at_pixels) {
    pixels_ = {context_, context_.program({"edge_mask.cl"}, maxima.defines()), "edge_mask_pixels"};
  } else {
    rows_ = {context_, opencl::joint_program(context_, {"edge_mask.cl"}), "edge_mask_rows"};
  }
  set(mask, margin);
}

void EdgeMask::set(const PixelMask& mask, int margin) {
  width_ = mask.width;
  height_ = mask.height;
  if (!mask.empty()) hidden_.write(context_, with_border(mask, margin).hidden);
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

EdgeSelection::EdgeSelection(opencl::Context& context, const EdgesConfig& config, const EdgeMaxima& maxima)
    : context_(context),
      budget_(config.budget),
      most_(static_cast<float>(config.max_spacing)),
      local_size_(context.is_cpu() ? 1 : 64),
      weighing_group_(std::min<std::size_t>(64, context.limits().group_items)) {
  spacing_.write(context, {0.0F});
  if (budget_ == 0) return;
  tally_.write(context, {0, 0});
  opencl::Defines defines = gradient_defines(config);
  defines.merge(maxima.defines());
  if (maxima.at_pixels) defines["GROUP"] = std::to_string(weighing_group_);
  const std::vector<std::string> files = {"edge_detection.cl", "edge_selection.cl"};
  const cl::Program program =
      maxima.at_pixels ? context.program(files, defines) : opencl::joint_program(context, files, defines);
  space_ = {context, program, "edge_selection_spacing"};
  if (maxima.at_pixels) {
    weigh_pixels_ = {context, program, "edge_selection_weigh_pixels"};
    choose_pixels_ = {context, program, "edge_selection_pixels"};
  } else {
    weigh_rows_ = {context, program, "edge_selection_weigh_rows"};
    choose_rows_ = {context, program, "edge_selection_rows"};
  }
}

void EdgeSelection::weigh(const SelectionArguments& arguments, const EdgeMaxima& maxima, cl_int image) {
  const std::size_t samples = (static_cast<std::size_t>(arguments.height) + kSelectionSample - 1) / kSelectionSample;
  if (maxima.at_pixels) {
    weigh_pixels_({samples * weighing_group_, weighing_group_}, arguments, maxima.winners, maxima.flags, image, tally_);
  } else {
    weigh_rows_({samples, local_size_}, arguments, maxima.winners, maxima.counts, image, tally_);
  }
}

void EdgeSelection::choose(const SelectionArguments& arguments, EdgeMaxima& maxima) {
  const auto rows = static_cast<std::size_t>(arguments.height), columns = static_cast<std::size_t>(arguments.width);
  if (maxima.at_pixels) {
    choose_pixels_({rows * columns, local_size_}, arguments, spacing_, maxima.winners, maxima.flags);
  } else {
    choose_rows_({rows, local_size_}, arguments, spacing_, maxima.winners, maxima.counts);
  }
}

void EdgeSelection::run(const SelectionArguments& in_left, const SelectionArguments& in_right, EdgeMaxima& left,
                        EdgeMaxima& right) {
  if (budget_ == 0) return;
  context_.begin_stage("edge_selection");
  weigh(in_left, left, 0);
  weigh(in_right, right, 1);
  space_({1, 1}, budget_, most_, tally_, spacing_);
  choose(in_left, left);
  choose(in_right, right);
}

}  // namespace quadedge::stages
