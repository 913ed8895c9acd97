#include "reference/edge_threshold.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "common/numeric.hpp"
#include "common/threshold_limits.hpp"

namespace quadedge::reference {
namespace {

constexpr double kBinsPerOctave = 8;
constexpr double kLowestExponent = -12;  // of the gradient that bin 1 begins with

/// Between powers of two the bins have equal width, as floats do.
double gradient_bin_start(int bin) {
  const int octave = (bin - 1) / 8, eighth = (bin - 1) % 8;
  return bin == 0 ? 0.0 : std::ldexp(1.0 + eighth / kBinsPerOctave, octave + static_cast<int>(kLowestExponent));
}

int gradient_bin(double magnitude) {
  int bin = 0;
  while (bin + 1 < kGradientBins && magnitude >= gradient_bin_start(bin + 1)) ++bin;
  return bin;
}

/// Integers below 16 have one bin each, larger ones eight bins per octave.
int noise_bin_start(int bin) { return bin < 16 ? bin : (8 + bin % 8) << (bin / 8 - 1); }

int noise_bin(int response) {
  int bin = 0;
  while (bin + 1 < kNoiseBins && response >= noise_bin_start(bin + 1)) ++bin;
  return bin;
}

double grey_at(const ImageView& image, int x, int y) {
  return static_cast<double>(image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1)));
}

bool is_saturated(double grey) { return grey <= 0 || grey >= kMaxGrey; }

double gradient_magnitude(const ImageView& image, int x, int y, double sigma) {
  const int radius = kernel_radius(sigma);
  double gx = 0, gy = 0;
  for (int dy = -radius; dy <= radius; ++dy) {
    const auto along_y = gaussian_derivatives(-dy, sigma);
    for (int dx = -radius; dx <= radius; ++dx) {
      const auto along_x = gaussian_derivatives(-dx, sigma);
      const double grey = grey_at(image, x + dx, y + dy);
      gx += along_x[1] * along_y[0] * grey;
      gy += along_x[0] * along_y[1] * grey;
    }
  }
  return std::hypot(gx, gy);
}

/// Magnitude of [1 -2 1] along both axes, in steps of the image's values; -1 where a pixel is saturated.
int noise_response(const ImageView& image, int x, int y) {
  constexpr int kWeights[3] = {1, -2, 1};
  double sum = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const double grey = grey_at(image, x + dx, y + dy);
      if (is_saturated(grey)) return -1;
      sum += kWeights[dy + 1] * kWeights[dx + 1] * grey;
    }
  }
  return static_cast<int>(std::lround(std::abs(sum) * image.max_value / kMaxGrey));
}

template <std::size_t N>
double sum_of(const std::array<std::int64_t, N>& tally) {
  return static_cast<double>(std::accumulate(tally.begin(), tally.end(), std::int64_t{0}));
}

}  // namespace

void ContrastTally::add(const ImageView& image, double sigma) {
  const int columns = image.width / kThresholdStep, rows = image.height / kThresholdStep;
  for (int row = 0; row < rows; ++row) {
    const int y = row * kThresholdStep + kThresholdStep / 2;
    for (int column = 0; column < columns; ++column) {
      const int x = column * kThresholdStep + kThresholdStep / 2;
      if (is_saturated(grey_at(image, x, y))) continue;
      ++gradients[static_cast<std::size_t>(gradient_bin(gradient_magnitude(image, x, y, sigma)))];
    }
    for (int x = 1; x < std::min(columns * kThresholdStep, image.width - 1); ++x) {
      const int response = noise_response(image, x, y);
      if (response >= 0) ++responses[static_cast<std::size_t>(noise_bin(response))];
    }
  }
}

double ContrastTally::gradient_exceeded_by(double ratio) const {
  const double wanted = ratio * sum_of(gradients);
  double above = 0;
  for (int bin = kGradientBins - 1; bin >= 0; --bin) {
    const auto here = static_cast<double>(gradients[static_cast<std::size_t>(bin)]);
    const double start = gradient_bin_start(bin), end = gradient_bin_start(bin + 1);
    if (here > 0 && above + here >= wanted) return end - (end - start) * (wanted - above) / here;
    above += here;
  }
  return 0;
}

double ContrastTally::noise() const {
  const double half = 0.5 * sum_of(responses);
  double below = 0;
  for (int bin = 0; bin < kNoiseBins; ++bin) {
    const auto here = static_cast<double>(responses[static_cast<std::size_t>(bin)]);
    // An integer represents half a step to either side.
    const double start = std::max(noise_bin_start(bin) - 0.5, 0.0), end = noise_bin_start(bin + 1) - 0.5;
    if (here > 0 && below + here >= half)
      return (start + (end - start) * (half - below) / here) / static_cast<double>(kNoiseMedian);
    below += here;
  }
  return 0;
}

double EdgeThreshold::next(const std::vector<ImageView>& images, std::optional<double> known_noise) {
  if (config_.threshold > 0) return config_.threshold;
  ContrastTally tally;
  for (const ImageView& image : images) tally.add(image, config_.sigma);
  const double step = kMaxGrey / images.front().max_value;  // [grey levels]
  noise_ = known_noise ? *known_noise : step * tally.noise();
  const ThresholdLimits limits = threshold_limits(config_);
  gradient_ = sum_of(tally.gradients) > 0 ? tally.gradient_exceeded_by(kThresholdArea) : kThresholdMax;
  const double contrast = gradient_ * gradient_ / kThresholdMax;
  const double measured =
      std::min(std::max({contrast, limits.per_noise * noise_, limits.per_step * step}), kThresholdMax);
  const double hold = kThresholdHold;
  const bool held = threshold_ <= hold * measured && measured <= hold * threshold_;
  if (!held) threshold_ = measured;
  return threshold_;
}

}  // namespace quadedge::reference
