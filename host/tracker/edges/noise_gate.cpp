/// \file noise_gate.cpp  Noise, corrected for interpolation by the table, against the gradient, with hysteresis.
#include "edges/noise_gate.hpp"

#include <cmath>
#include <vector>

#include "common/filter_limits.hpp"
#include "common/layouts.hpp"

namespace quadedge::frontend {
namespace {

constexpr double kSmoothingVariance = 4.0;  ///< that smoothing adds along either axis [px^2]
/// The gate opens where the limit of noise exceeds the gradient that a fifth of the images exceeds, so that fewer edges
/// than that would be left, and closes at a noise lower by this factor.
constexpr double kHold = 1.25;

/// Variance of the response of [1 -2 1] to noise of variance 1, interpolated `fraction` of a pixel from its samples.
double response_variance(double fraction) {
  const double a = 1 - fraction, b = fraction;
  return a * a + (b - 2 * a) * (b - 2 * a) + (a - 2 * b) * (a - 2 * b) + b * b;
}

}  // namespace

double measured_noise_ratio(const UndistortionTable& table) {
  if (table.empty()) return 1;
  std::vector<double> deviations;
  const auto fraction = [](float position) { return static_cast<double>(position - std::floor(position)); };
  for (int y = 0; y < table.height; y += kThresholdStep) {
    for (int x = 0; x < table.width; x += kThresholdStep) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(table.width) + static_cast<std::size_t>(x);
      deviations.push_back(std::sqrt(response_variance(fraction(table.source_x[i])) *
                                     response_variance(fraction(table.source_y[i])) / 36));
    }
  }
  // The median magnitude of a mixture of normal distributions, by bisection.
  constexpr double kMedianOfNormal = 0.6744898;
  double low = 0, high = kMedianOfNormal;
  for (int step = 0; step < 30; ++step) {
    const double middle = 0.5 * (low + high);
    double below = 0;
    for (const double deviation : deviations) below += std::erf(middle / (deviation * std::sqrt(2.0)));
    (below < 0.5 * static_cast<double>(deviations.size()) ? low : high) = middle;
  }
  return high / kMedianOfNormal;
}

NoiseGate::NoiseGate(const StereoRig& rig, const EdgesConfig& config)
    : per_noise_(threshold_limits(config).per_noise),
      ratio_(0.5 * (measured_noise_ratio(rig.left_undistortion) + measured_noise_ratio(rig.right_undistortion))),
      smoothed_(config.sigma * config.sigma / (config.sigma * config.sigma + kSmoothingVariance)) {}

bool NoiseGate::judge(double noise, double gradient) {
  const double recorded = noise / ratio_;
  smoothed_noise_ = smoothed_ * recorded;
  is_open_ = (is_open_ ? kHold : 1) * per_noise_ * recorded > gradient;
  return is_open_;
}

}  // namespace quadedge::frontend
