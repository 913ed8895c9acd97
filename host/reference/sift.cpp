#include "reference/sift.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/matching_constants.hpp"
#include "common/parallel.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::reference {
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

void store(const Histogram& histogram, std::uint8_t* descriptor) {
  double squares = 0;
  for (double value : histogram) squares += value * value;
  const double clip = kSiftClip * std::sqrt(squares);
  double clipped_squares = 0;
  for (double value : histogram) clipped_squares += std::pow(std::min(value, clip), 2);
  const double scale = clipped_squares > 0 ? kSiftNorm / std::sqrt(clipped_squares) : 0.0;
  for (int k = 0; k < kSiftBytes; ++k) {
    descriptor[k] = static_cast<std::uint8_t>(std::min(std::round(std::min(histogram[k], clip) * scale), 255.0));
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
