#pragma once
/// \file threshold_limits.hpp  Gradients caused by noise and quantisation. doc/method.md section 1.

#include <cmath>

#include "quadedge/config.hpp"
#include "quadedge/pi.hpp"

namespace quadedge {

constexpr double kMaxGrey = 255;  ///< grey level at which a camera saturates, at any bit depth

/// Lower limits of an automatic threshold [grey levels per px].
struct ThresholdLimits {
  double per_noise;  ///< per grey level of the noise's standard deviation
  double per_step;   ///< per grey level between adjacent values of the recorded image
};

/// White noise of standard deviation 1 has gradients of 1 / (sqrt(8 pi) sigma^2) along either axis; a step of height 1
/// has a gradient of 1 / (sqrt(2 pi) sigma).
inline ThresholdLimits threshold_limits(const EdgesConfig& config) {
  return {config.threshold_noise / (std::sqrt(8.0 * kPi) * config.sigma * config.sigma),
          config.threshold_steps / (std::sqrt(2.0 * kPi) * config.sigma)};
}

}  // namespace quadedge
