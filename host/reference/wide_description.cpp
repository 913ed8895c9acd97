#include "reference/wide_description.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "quadedge/camera.hpp"

namespace quadedge::reference {
namespace {

double sample(const SmallImage& small, double x, double y) {
  x = std::clamp(x, 0.0, small.width - 1.0);
  y = std::clamp(y, 0.0, small.height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, small.width - 1), y1 = std::min(y0 + 1, small.height - 1);
  const auto at = [&](int column, int row) {
    return static_cast<double>(small.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(small.width) +
                                            static_cast<std::size_t>(column)]);
  };
  const double fx = x - x0, fy = y - y0;
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x1, y0)) + fy * ((1 - fx) * at(x0, y1) + fx * at(x1, y1));
}

/// Weight that a sample `offset` small pixels from the middle has in a cell, along one axis; the Gaussian window
/// included.
double cell_weight(int offset, int cell) {
  const double at = offset / kWideCellWidth;
  return std::max(0.0, 1 - std::abs(at - (cell - 0.5 * (kWideCells - 1)))) * std::exp(-at * at / 8);
}

void describe(const SmallImage& small, double x, double y, double direction, std::uint8_t* descriptor) {
  const double c = std::cos(direction), s = std::sin(direction);
  const auto at = [&](int along, int across) {
    return sample(small, x + along * c - across * s, y + along * s + across * c);
  };
  std::array<double, kWideBytes> histogram{};
  for (int v = -kWideHalf; v <= kWideHalf; ++v) {
    for (int u = -kWideHalf; u <= kWideHalf; ++u) {
      const double along = at(u + 1, v) - at(u - 1, v), across = at(u, v + 1) - at(u, v - 1);
      const double length = std::hypot(along, across);
      if (!(length > 0)) continue;
      for (int cell = 0; cell < kWideCells * kWideCells; ++cell) {
        const double weight = length * cell_weight(v, cell / kWideCells) * cell_weight(u, cell % kWideCells);
        for (int bin = 0; bin < kWideAngles; ++bin) {
          const double angle = 2 * kPi * bin / kWideAngles;
          const double cosine = std::max(0.0, (along * std::cos(angle) + across * std::sin(angle)) / length);
          histogram[static_cast<std::size_t>(cell * kWideAngles + bin)] += weight * cosine * cosine * cosine;
        }
      }
    }
  }
  double squares = 0, clipped = 0;
  for (double value : histogram) squares += value * value;
  const double clip = kWideClip * std::sqrt(squares);
  for (double value : histogram) clipped += std::pow(std::min(value, clip), 2);
  const double scale = clipped > 0 ? kWideNorm / std::sqrt(clipped) : 0.0;
  for (double value : histogram)
    *descriptor++ = static_cast<std::uint8_t>(std::min(std::round(std::min(value, clip) * scale), 255.0));
}

}  // namespace

SmallImage shrink(const ImageView& image) {
  SmallImage small;
  small.width = image.width / kWideShrink;
  small.height = image.height / kWideShrink;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      float sum = 0;
      for (int row = 0; row < kWideShrink; ++row)
        for (int column = 0; column < kWideShrink; ++column)
          sum += image.at(kWideShrink * x + column, kWideShrink * y + row);
      small.pixels.push_back(sum / (kWideShrink * kWideShrink));
    }
  }
  return small;
}

std::vector<std::uint8_t> wide_descriptions(const SmallImage& small, const StereoEdges& edges, int step) {
  const auto stride = static_cast<std::size_t>(step);
  std::vector<std::uint8_t> descriptors((edges.size() + stride - 1) / stride * kWideBytes);
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    const double middle = 0.5 * (kWideShrink - 1);
    describe(small, (static_cast<double>(edges.left_x[i]) - middle) / kWideShrink,
             (static_cast<double>(edges.left_y[i]) - middle) / kWideShrink,
             static_cast<double>(edges.left_direction[i]), descriptors.data() + i / stride * kWideBytes);
  }
  return descriptors;
}

}  // namespace quadedge::reference
