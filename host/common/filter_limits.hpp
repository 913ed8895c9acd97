#pragma once
/// \file filter_limits.hpp  Search areas of the temporal matching; derived limits of the filters, for stereo and for
/// each kind of temporal search, and the selection of quads. Shared by kernels, reference and evaluation.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "common/matching_constants.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"

namespace quadedge {

/// One entry per stereo edge of the base, an earlier rig: its predicted position in the current images.
struct TemporalSearch {
  EdgePositions left, right;
  float radius = 0;     ///< [px], around the predicted position
  int step = 1;         ///< only every step-th previous edge is matched
  bool coarse = false;  ///< whether the limits TemporalConfig::coarse_* apply
};

/// Indices of the stereo edges of the base and of the current rig that take part in a global search.
struct GlobalSearch {
  std::vector<std::int32_t> of_base, of_current;
};

/// Step of the edges used in a global search, so that about `wanted` of `count` take part.
inline int wide_step(std::size_t count, int wanted) {
  const int step = static_cast<int>(count) / wanted;
  return step > 1 ? step : 1;
}

inline FilterLimits stereo_limits(const StereoConfig& config) {
  return {static_cast<float>(config.ncc_min),
          static_cast<float>(config.sift_max),
          static_cast<float>(config.ncc_nearly_best),
          static_cast<float>(kSiftNearlyBest),
          order_of(StereoFilter::ncc),
          order_of(StereoFilter::sift)};
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
  if (!search.coarse) {
    return {static_cast<float>(config.ncc_min),
            static_cast<float>(config.sift_max),
            static_cast<float>(config.ncc_nearly_best),
            static_cast<float>(config.sift_nearly_best),
            order_of(TemporalFilter::ncc),
            order_of(TemporalFilter::sift)};
  }
  const bool wide = search.radius > static_cast<float>(config.coarse_radius);
  return {static_cast<float>(kCoarseNccMin),
          static_cast<float>(wide ? kCoarseWideSiftMax : config.sift_max),
          static_cast<float>(kCoarseNccNearlyBest),
          static_cast<float>(kCoarseSiftNearlyBest),
          order_of(TemporalFilter::ncc),
          order_of(TemporalFilter::sift)};
}

inline QuadChoice quad_choice(const TemporalConfig& config, const TemporalSearch& search) {
  return {static_cast<float>(config.distance_weight) / (search.radius * search.radius), static_cast<float>(kClusterGap),
          static_cast<float>(kClusterOrientation)};
}

}  // namespace quadedge
