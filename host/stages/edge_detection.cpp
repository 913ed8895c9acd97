#include "stages/edge_detection.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "common/gaussian_taps.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"

namespace quadedge::stages {
namespace {

constexpr int kStripRows = 64;  // rows of the doubled grid that one work-item filters: two more are computed twice
constexpr std::size_t kPadGroup = 32;  // work-items per group of the padding kernel

int round_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

std::string float_literal(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  text << std::showpoint << value << "f";
  return text.str();
}

/// Weights of the pairs at k + phase and -k: for phase 0 those of G, then of G', then the same for phase 1.
std::vector<cl_float> pair_taps(double sigma) {
  const int radius = kernel_radius(sigma);
  std::vector<cl_float> taps;
  for (int phase = 0; phase < 2; ++phase) {
    for (std::size_t order = 0; order < 2; ++order) {
      for (int k = 0; k <= radius; ++k) {
        // The pixel at k + phase seen from the centre at phase / 2. The middle pixel of phase 0 counts twice in its
        // pair.
        const double weight = gaussian_derivatives(0.5 * phase - (k + phase), sigma)[order];
        taps.push_back(static_cast<cl_float>(phase == 0 && k == 0 ? 0.5 * weight : weight));
      }
    }
  }
  return taps;
}

}  // namespace

EdgeDetection::EdgeDetection(opencl::Context& context, int width, int height, const EdgesConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), width_(width), height_(height), config_(config), scan_(context, variants) {
  if (width < 1 || height < 1) throw UsageError("edge detection needs an image of at least 1 x 1 pixels");
  build(variants);
  const int radius = kernel_radius(config.sigma);
  const int pad_x = 16 * ((radius + 18) / 16), pad_y = radius + 2;  // as in kernels/edge_detection.cl
  plane_.stride = pad_x + round_up(width + radius + 18, 16);
  plane_.rows = height + 2 * pad_y;
  plane_.pixels.ensure(context, static_cast<std::size_t>(plane_.stride) * static_cast<std::size_t>(plane_.rows));
  taps_.write(context, pair_taps(config.sigma));

  const auto cells = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto capacity = static_cast<std::size_t>(config.max_edges);
  winners_.ensure(context, 4 * cells);
  counts_.ensure(context, 2 * static_cast<std::size_t>(height));
  if (strips_) {
    line_ = kStripLineFront + round_up(width + 2 * radius + 2 + 32, 16);
    const int strips = (2 * height + kStripRows - 1) / kStripRows;
    scratch_.ensure(context,
                    static_cast<std::size_t>(strips) * kStripLines * static_cast<std::size_t>(line_) + kStripLineFront);
  } else {
    flags_.ensure(context, cells);
    compact_.ensure(context, 4 * capacity);
    rows_.ensure(context, capacity);
  }
  if (config.thinning) thinning_.emplace(context, height, config.max_edges, variants);
}

void EdgeDetection::build(const std::map<std::string, std::string>& variants) {
  const auto& variant = opencl::choose_variant("edge_detection", context_, variants);
  strips_ = variant.name.rfind("strip", 0) == 0;
  local_size_ = static_cast<std::size_t>(variant.local_size);
  opencl::Defines defines = variant.defines;
  defines["RADIUS"] = std::to_string(kernel_radius(config_.sigma));
  defines["SIGMA"] = float_literal(config_.sigma);
  defines["AT_CELL"] = config_.direction_at == "cell" ? "1" : "0";
  if (strips_) {
    const cl::Program program = context_.program({"edge_detection.cl", "edge_detection_strip.cl"}, defines);
    pad_ = {context_, program, "edges_pad"};
    strip_maxima_ = {context_, program, "edges_strip_maxima"};
    strip_directions_ = {context_, program, "edges_strip_directions"};
  } else {
    const int tile_x = std::stoi(defines.at("TILE_X")), tile_y = std::stoi(defines.at("TILE_Y"));
    tiles_x_ = (width_ + tile_x - 1) / tile_x;
    tiles_y_ = (height_ + tile_y - 1) / tile_y;
    defines["LOCAL"] = std::to_string(variant.local_size);
    const cl::Program program = context_.program({"edge_detection.cl", "edge_detection_tile.cl"}, defines);
    pad_ = {context_, program, "edges_pad"};
    tile_maxima_ = {context_, program, "edges_tile_maxima"};
    tile_count_ = {context_, program, "edges_tile_count"};
    tile_compact_ = {context_, program, "edges_tile_compact"};
    tile_directions_ = {context_, program, "edges_tile_directions"};
  }
}

DetectionArguments EdgeDetection::arguments() const {
  const double newton_max = config_.direction_at == "cell" ? 0.0 : config_.newton_max;
  return {width_,           height_,
          plane_.stride,    static_cast<float>(config_.threshold),
          config_.margin,   static_cast<float>(newton_max),
          config_.max_edges};
}

void EdgeDetection::run(const opencl::Buffer<cl_uchar>& image, DeviceEdges& edges) {
  if (!thinning_) return detect(image, edges);
  detect(image, all_);
  thinning_->run(all_, edges);
}

void EdgeDetection::detect(const opencl::Buffer<cl_uchar>& image, DeviceEdges& edges) {
  context_.begin_stage("edge_detection");
  edges.reserve(context_, config_.max_edges);
  const DetectionArguments arguments = this->arguments();
  const auto rows = static_cast<std::size_t>(2 * height_);
  pad_({static_cast<std::size_t>(plane_.stride / 16), static_cast<std::size_t>(plane_.rows), kPadGroup, 1}, image,
       width_, height_, plane_.pixels, plane_.stride);
  if (strips_) {
    find_maxima_in_strips();
    scan_.run(counts_, 2 * height_, config_.max_edges, edges.row_first, edges.count);
    strip_directions_({rows, local_size_}, arguments, plane_.pixels, winners_, counts_, edges.row_first, edges.packed);
  } else {
    find_maxima_in_tiles();
    scan_.run(counts_, 2 * height_, config_.max_edges, edges.row_first, edges.count);
    tile_compact_({rows * local_size_, local_size_}, flags_, 2 * width_, winners_, edges.row_first, config_.max_edges,
                  compact_, rows_);
    tile_directions_({8 * static_cast<std::size_t>(config_.max_edges), local_size_}, arguments, plane_.pixels, compact_,
                     rows_, edges.count, edges.packed);
  }
}

void EdgeDetection::find_maxima_in_strips() {
  const auto strips = static_cast<std::size_t>((2 * height_ + kStripRows - 1) / kStripRows);
  strip_maxima_({strips, local_size_}, arguments(), kStripRows, plane_.pixels, taps_, scratch_, line_, winners_,
                counts_);
}

void EdgeDetection::find_maxima_in_tiles() {
  const auto tiles = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  tile_maxima_({tiles * local_size_, local_size_}, arguments(), tiles_x_, plane_.pixels, taps_, winners_, flags_);
  tile_count_({2 * static_cast<std::size_t>(height_) * local_size_, local_size_}, flags_, 2 * width_, counts_);
}

}  // namespace quadedge::stages
