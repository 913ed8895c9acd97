#include "stages/padded_plane.hpp"

#include <sstream>
#include <vector>

#include "common/gaussian_taps.hpp"
#include "common/numeric.hpp"
#include "quadedge/error.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kPadGroup = 32;  // work-items per group of the padding kernel

std::string float_literal(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  text << std::showpoint << value << "f";
  return text.str();
}

/// Weights of the pairs at k and -k: those of G, then of G'.
std::vector<cl_float> pair_taps(double sigma) {
  const int radius = kernel_radius(sigma);
  std::vector<cl_float> taps;
  for (std::size_t order = 0; order < 2; ++order) {
    for (int k = 0; k <= radius; ++k)
      taps.push_back(static_cast<cl_float>(gaussian_derivatives(-k, sigma)[order]));  // the pixel at k, from the centre
  }
  return taps;
}

}  // namespace

opencl::Defines gradient_defines(const EdgesConfig& config) {
  return {{"RADIUS", std::to_string(kernel_radius(config.sigma))},
          {"SIGMA", float_literal(config.sigma)},
          {"AT_PIXEL", config.direction_at == "pixel" ? "1" : "0"}};
}

PaddedPlane::PaddedPlane(opencl::Context& context, int width, int height, double sigma, int max_value)
    : width_(width), height_(height), max_value_(max_value) {
  if (width < 1 || height < 1) throw UsageError("edge detection needs an image of at least 1 x 1 pixels");
  const int radius = kernel_radius(sigma);
  const int pad_x = 16 * ((radius + 18) / 16), pad_y = radius + 2;  // as in kernels/edge_detection.cl
  stride_ = pad_x + round_up(width + radius + 18, 16);
  rows_ = height + 2 * pad_y;
  pixels_.ensure(context, static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_));
  taps_.write(context, pair_taps(sigma));
  EdgesConfig config;
  config.sigma = sigma;
  pad_ = {context,
          context.program({"edge_detection.cl", "padded_plane.cl"}, image_defines(max_value, gradient_defines(config))),
          "edges_pad"};
}

void PaddedPlane::prepare(const opencl::Buffer<cl_uchar>& image) {
  pad_({static_cast<std::size_t>(stride_ / 16), static_cast<std::size_t>(rows_), kPadGroup, 1}, image, width_, height_,
       pixels_, stride_);
}

}  // namespace quadedge::stages
