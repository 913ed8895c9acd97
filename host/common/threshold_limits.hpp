#pragma once
/// \file threshold_limits.hpp  Gradients caused by noise and quantisation. doc/method.md section 1.

#include <cmath>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

constexpr double kMaxGrey = 255;  ///< grey level at which a camera saturates, at any bit depth

/// Maximum of the automatic threshold [grey levels/px], used at normal contrast.
constexpr double kThresholdMax = 2.0;

/// The threshold is lowered until the gradient exceeds it in this fraction of the image, which images of normal
/// contrast reach at the maximum.
constexpr double kThresholdArea = 0.2;

/// Limits below: standard deviations of the gradient of noise, which its local maxima hardly ever exceed, and
/// quantisation steps of an edge, as edges of a single step are not fixed to any surface.
constexpr double kThresholdNoise = 5.0, kThresholdSteps = 2.0;

/// Lower limits of an automatic threshold [grey levels per px].
struct ThresholdLimits {
  double per_noise;  ///< per grey level of the noise's standard deviation
  double per_step;   ///< per grey level between adjacent values of the recorded image
};

/// White noise of standard deviation 1 has gradients of 1 / (sqrt(8 pi) sigma^2) along either axis; a step of height 1
/// has a gradient of 1 / (sqrt(2 pi) sigma).
inline ThresholdLimits threshold_limits(const EdgesConfig& config) {
  return {kThresholdNoise / (std::sqrt(8.0 * kPi) * config.sigma * config.sigma),
          kThresholdSteps / (std::sqrt(2.0 * kPi) * config.sigma)};
}

}  // namespace quadedge
