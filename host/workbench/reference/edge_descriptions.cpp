/// \file edge_descriptions.cpp  Patches, SIFT and wide descriptors in double precision, stored as on the device.
#include "reference/edge_descriptions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/layouts.hpp"
#include "common/matching_constants.hpp"
#include "common/parallel.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::reference {
namespace {

constexpr double kRowStep = static_cast<double>(kPatchRowStep);

/// Between the values of a grid of width x height, whose border is replicated.
template <class Value>
double bilinear(int width, int height, double x, double y, const Value& value) {
  x = std::clamp(x, 0.0, width - 1.0);
  y = std::clamp(y, 0.0, height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const double fx = x - x0, fy = y - y0;
  const double top = value(x0, y0) + fx * (value(x1, y0) - value(x0, y0));
  const double bottom = value(x0, y1) + fx * (value(x1, y1) - value(x0, y1));
  return top + fy * (bottom - top);
}

/// Clips bins, normalises them and stores them as bytes, as SIFT does (Lowe 2004, section 6).
template <std::size_t Bins>
void store(const std::array<double, Bins>& histogram, std::uint8_t* descriptor) {
  double squares = 0, clipped_squares = 0;
  for (const double value : histogram) squares += value * value;
  const double clip = kHistogramClip * std::sqrt(squares);
  for (const double value : histogram) clipped_squares += std::pow(std::min(value, clip), 2);
  const double scale = clipped_squares > 0 ? kHistogramNorm / std::sqrt(clipped_squares) : 0.0;
  for (const double value : histogram)
    *descriptor++ = static_cast<std::uint8_t>(std::min(std::round(std::min(value, clip) * scale), 255.0));
}

}  // namespace

PatchFrame patch_frame(double x, double y, double cosine, double sine, double side, double offset) {
  constexpr double kAlong = kRowStep * (kPatchRows / 2), kAcross = kPatchSide / 2;  // from the centre to the sample
  return {x + side * offset * sine - kAlong * cosine + kAcross * sine,
          y - side * offset * cosine - kAlong * sine - kAcross * cosine, cosine, sine};
}

double grey_at(const ImageView& image, double x, double y) {
  return bilinear(image.width, image.height, x, y,
                  [&](int px, int py) { return static_cast<double>(image.at(px, py)); });
}

PatchValues cut_patch(const ImageView& image, const PatchFrame& frame, double dx, double dy) {
  PatchValues values{};
  for (int i = 0; i < kPatchRows; ++i) {
    for (int j = 0; j < kPatchSide; ++j) {
      const double along = kRowStep * i;
      values[static_cast<std::size_t>(kPatchSide * i + j)] =
          grey_at(image, frame.x + dx + along * frame.cosine - j * frame.sine,
                  frame.y + dy + along * frame.sine + j * frame.cosine);
    }
  }
  // Subtracting the middle sample first makes a constant patch exactly zero.
  const double middle = values[kPatchSamples / 2];
  double sum = 0;
  for (double& value : values) sum += value -= middle;
  for (double& value : values) value -= sum / kPatchSamples;
  return values;
}

PatchValues patch_derivative(const ImageView& image, const PatchFrame& frame, double ex, double ey) {
  const PatchValues ahead = cut_patch(image, frame, 0.5 * ex, 0.5 * ey);
  PatchValues values = cut_patch(image, frame, -0.5 * ex, -0.5 * ey);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = ahead[k] - values[k];
  return values;
}

double huber_weight(double residual, double limit) {
  return std::abs(residual) <= limit ? 1.0 : limit / std::abs(residual);
}

double patch_norm(const PatchValues& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares);
}

double patch_ncc(const PatchValues& a, const PatchValues& b) {
  const double norms = patch_norm(a) * patch_norm(b);
  return norms < 1e-10 ? 0 : std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / norms;
}

std::optional<Alignment> align_edge(const ImageView& image, const PatchFrame& moving, double ex, double ey,
                                    const PatchValues& fixed, const PatchValues& derivative, double stiffness,
                                    const RefinementSettings& settings) {
  double move = 0;
  for (int step = 0; step < settings.steps; ++step) {
    const PatchValues values = cut_patch(image, moving, move * ex, move * ey);
    const double gain = std::clamp(patch_norm(fixed) / std::max(patch_norm(values), 1e-3),
                                   1 / static_cast<double>(kGainMax), static_cast<double>(kGainMax));
    double curvature = stiffness, slope = -stiffness * move;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double residual = fixed[k] - gain * values[k];
      const double weight = huber_weight(residual, settings.huber);
      curvature += weight * derivative[k] * derivative[k];
      slope += weight * derivative[k] * residual;
    }
    const double change = curvature < 1e-6 ? 0 : slope / curvature;
    move += change;
    if (!(std::abs(move) <= settings.clamp)) return std::nullopt;
    if (std::abs(change) < settings.tolerance) return Alignment{move, values};
  }
  return Alignment{move, cut_patch(image, moving, move * ex, move * ey)};
}

namespace {

float side_ncc(const std::int8_t* a, int side_a, const std::int8_t* b, int side_b) {
  int products = 0;
  for (int k = 0; k < kPatchSamples; ++k) products += a[sample_position(side_a, k)] * b[sample_position(side_b, k)];
  return static_cast<float>(products) * inverse_norm(a, side_a) * inverse_norm(b, side_b);
}

}  // namespace

std::vector<std::int8_t> side_patches(const ImageView& image, const std::vector<float>& xs,
                                      const std::vector<float>& ys, const std::vector<float>& directions,
                                      const PatchesConfig& config) {
  std::vector<std::int8_t> patches(xs.size() * kEdgePatchBytes);
  for (std::size_t e = 0; e < xs.size(); ++e) {
    const double c = std::cos(static_cast<double>(directions[e])), s = std::sin(static_cast<double>(directions[e]));
    std::int8_t* edge = patches.data() + e * kEdgePatchBytes;
    for (const int side : {0, 1}) {
      const PatchFrame frame = patch_frame(xs[e], ys[e], c, s, side == 0 ? 1 : -1, config.offset);
      store_side(cut_patch(image, frame, 0, 0), side, edge);
    }
  }
  return patches;
}

float patch_ncc(const std::int8_t* a, const std::int8_t* b) {
  return std::max({side_ncc(a, 0, b, 0), side_ncc(a, 1, b, 1), side_ncc(a, 0, b, 1), side_ncc(a, 1, b, 0)});
}

namespace {

double sample(const SmallImage& small, double x, double y) {
  return bilinear(small.width, small.height, x, y, [&](int column, int row) {
    return static_cast<double>(small.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(small.width) +
                                            static_cast<std::size_t>(column)]);
  });
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
  store(histogram, descriptor);
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

namespace {

/// Index inside [0, size) after reflection about the outermost pixels (edge pixel not repeated).
int reflect(int i, int size) {
  if (size == 1) return 0;
  while (i < 0 || i >= size) i = i < 0 ? -i : 2 * (size - 1) - i;
  return i;
}

std::vector<double> blur(const ImageView& image) {
  constexpr int kR = kSiftBlurRadius;
  std::array<double, 2 * kR + 1> weights;
  const double variance = kSiftBaseSigma * kSiftBaseSigma - kSiftAssumedSigma * kSiftAssumedSigma;
  double sum = 0;
  for (int k = -kR; k <= kR; ++k) sum += weights[k + kR] = std::exp(-k * k / (2 * variance));
  for (double& weight : weights) weight /= sum;

  const int width = image.width, height = image.height;
  std::vector<double> rows(static_cast<std::size_t>(width) * height), blurred(rows.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double value = 0;
      for (int k = -kR; k <= kR; ++k) value += weights[k + kR] * image.at(reflect(x + k, width), y);
      rows[static_cast<std::size_t>(y) * width + x] = value;
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double value = 0;
      for (int k = -kR; k <= kR; ++k) {
        value += weights[k + kR] * rows[static_cast<std::size_t>(reflect(y + k, height)) * width + x];
      }
      blurred[static_cast<std::size_t>(y) * width + x] = value;
    }
  }
  return blurred;
}

using Histogram = std::array<double, kSiftBytes>;

/// Shares one sample of weight `weight` between the neighbouring bins: linear in both cells and in the angle.
void add_sample(Histogram& histogram, double across, double along, double angle, double weight) {
  const int across0 = static_cast<int>(std::floor(across)), along0 = static_cast<int>(std::floor(along));
  const int angle0 = static_cast<int>(std::floor(angle));
  for (int r = across0; r <= across0 + 1; ++r) {
    for (int c = along0; c <= along0 + 1; ++c) {
      if (r < 0 || r >= kSiftCells || c < 0 || c >= kSiftCells) continue;
      for (int o = angle0; o <= angle0 + 1; ++o) {
        const double share = (1 - std::abs(across - r)) * (1 - std::abs(along - c)) * (1 - std::abs(angle - o));
        const int bin = ((o % kSiftAngles) + kSiftAngles) % kSiftAngles;
        histogram[(r * kSiftCells + c) * kSiftAngles + bin] += weight * share;
      }
    }
  }
}

}  // namespace

GradientMap sift_gradients(const ImageView& image) {
  const std::vector<double> blurred = blur(image);
  GradientMap map{image.width, image.height, std::vector<double>(blurred.size()), std::vector<double>(blurred.size())};
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
      const double dx = blurred[i + 1] - blurred[i - 1], dy = blurred[i + image.width] - blurred[i - image.width];
      map.magnitude[i] = std::hypot(dx, dy);
      map.angle[i] = std::atan2(dy, dx);
    }
  }
  return map;
}

void sift_descriptor(const GradientMap& map, float x, float y, float direction, std::uint8_t* descriptor) {
  const double centre_x = std::nearbyint(x), centre_y = std::nearbyint(y);
  const double c = std::cos(static_cast<double>(direction)) / kSiftCellWidth;
  const double s = std::sin(static_cast<double>(direction)) / kSiftCellWidth;
  constexpr double kMiddle = 0.5 * (kSiftCells - 1);                  // the window's centre, counted in cells
  constexpr double kWindow = -1.0 / (0.5 * kSiftCells * kSiftCells);  // Gaussian of half the window's width
  Histogram histogram{};
  for (int i = -kSiftRadius; i <= kSiftRadius; ++i) {
    for (int j = -kSiftRadius; j <= kSiftRadius; ++j) {
      const double along = j * c + i * s, across = i * c - j * s;
      if (std::abs(along) >= 0.5 * (kSiftCells + 1) || std::abs(across) >= 0.5 * (kSiftCells + 1)) continue;
      const double column = centre_x + j, row = centre_y + i;
      if (column < 1 || column > map.width - 2 || row < 1 || row > map.height - 2) continue;
      const std::size_t k = static_cast<std::size_t>(row) * map.width + static_cast<std::size_t>(column);
      const double weight = map.magnitude[k] * std::exp(kWindow * (along * along + across * across));
      const double angle = (direction - map.angle[k]) * kSiftAngles / (2 * kPi);
      add_sample(histogram, across + kMiddle, along + kMiddle, angle, weight);
    }
  }
  store(histogram, descriptor);
}

std::vector<std::uint8_t> sift_descriptors(const ImageView& image, const std::vector<float>& xs,
                                           const std::vector<float>& ys, const std::vector<float>& directions) {
  const GradientMap map = sift_gradients(image);
  std::vector<std::uint8_t> descriptors(xs.size() * kEdgeSiftBytes);
  for_row_blocks(xs.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      // Rounded like on the device, because the nearest pixel is a discrete choice.
      const float offset = static_cast<float>(kSiftOffset);
      const float to_dark_x = offset * static_cast<float>(std::sin(static_cast<double>(directions[e])));
      const float to_dark_y = -offset * static_cast<float>(std::cos(static_cast<double>(directions[e])));
      std::uint8_t* edge = descriptors.data() + e * kEdgeSiftBytes;
      sift_descriptor(map, xs[e] + to_dark_x, ys[e] + to_dark_y, directions[e], edge);
      sift_descriptor(map, xs[e] - to_dark_x, ys[e] - to_dark_y, directions[e], edge + kSiftBytes);
    }
  });
  return descriptors;
}

int sift_distance2(const std::uint8_t* a, const std::uint8_t* b) {
  int best = INT32_MAX;
  for (int side_a = 0; side_a < 2; ++side_a) {
    for (int side_b = 0; side_b < 2; ++side_b) {
      int sum = 0;
      for (int k = 0; k < kSiftBytes; ++k) {
        const int difference = a[side_a * kSiftBytes + k] - b[side_b * kSiftBytes + k];
        sum += difference * difference;
      }
      best = std::min(best, sum);
    }
  }
  return best;
}

}  // namespace quadedge::reference
