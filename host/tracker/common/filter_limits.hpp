#pragma once
/// \file filter_limits.hpp  Limits derived from the configuration: of the gradients that noise causes, of search
/// areas, and of the filters.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "common/matching_constants.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/filters.hpp"

namespace quadedge {

/// One entry per stereo edge of the base, an earlier frame: its predicted position in the current images.
struct TemporalSearch {
  EdgePositions left, right;
  float radius = 0;     ///< [px], around the predicted position
  int step = 1;         ///< only every step-th previous edge is matched
  bool coarse = false;  ///< whether the limits TemporalConfig::coarse_* apply
};

/// Indices of the stereo edges of the base and of the current frame that take part in a global search.
struct GlobalSearch {
  std::vector<std::int32_t> of_base, of_current;
};

/// Step of the edges used in a global search, so that about `wanted` of `count` take part.
inline int global_step(std::size_t count, int wanted) {
  const int step = static_cast<int>(count) / wanted;
  return step > 1 ? step : 1;
}

template <class Filter>
FilterLimits filter_limits(double ncc_min, double sift_max, double ncc_nearly_best, double sift_nearly_best) {
  const auto value = [](double limit) { return static_cast<float>(limit); };
  return {value(ncc_min),          value(sift_max),       value(ncc_nearly_best),
          value(sift_nearly_best), order_of(Filter::ncc), order_of(Filter::sift)};
}

inline FilterLimits stereo_limits(const StereoConfig& config) {
  return filter_limits<StereoFilter>(config.ncc_min, config.sift_max, config.ncc_nearly_best, kSiftNearlyBest);
}

/// Weight of full support by the neighbours relative to similarity; 0 without relaxation.
inline float support_weight(const StereoConfig& config) {
  return config.relaxation_rounds > 0 ? static_cast<float>(kSupportWeight) : 0.0F;
}

/// Filter 9: the lowest similarity that support can raise to refined_ncc_min.
inline float lowest_similarity(const StereoConfig& config) {
  return static_cast<float>(config.refined_ncc_min) - support_weight(config);
}

/// Number of relaxation cells along a side of the left image of `pixels` px.
inline int relaxation_cells(int pixels) { return static_cast<int>(static_cast<float>(pixels) / kRelaxationCell) + 1; }

inline FilterLimits temporal_limits(const TemporalConfig& config, const TemporalSearch& search) {
  if (!search.coarse)
    return filter_limits<TemporalFilter>(config.ncc_min, config.sift_max, config.ncc_nearly_best,
                                         config.sift_nearly_best);
  const bool wide = search.radius > static_cast<float>(config.coarse_radius);
  return filter_limits<TemporalFilter>(kCoarseNccMin, wide ? kLargeRadiusSiftMax : config.sift_max,
                                       kCoarseNccNearlyBest, kCoarseSiftNearlyBest);
}

inline QuadChoice quad_choice(const TemporalConfig& config, const TemporalSearch& search) {
  return {static_cast<float>(config.distance_weight) / (search.radius * search.radius), static_cast<float>(kClusterGap),
          static_cast<float>(kClusterOrientation)};
}

// Gradients caused by noise and quantisation. doc/method.md section 1.

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
