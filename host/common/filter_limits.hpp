#pragma once
/// \file filter_limits.hpp  Derived limits of the filters, for stereo and for each kind of temporal search, and the
/// selection of quads in a temporal search. Shared by kernels, reference and evaluation.

#include "common/layouts.hpp"
#include "common/temporal_search.hpp"
#include "quadedge/config.hpp"
#include "quadedge/filters.hpp"

namespace quadedge {

inline FilterLimits stereo_limits(const StereoConfig& config) {
  return {static_cast<float>(config.ncc_min),
          static_cast<float>(config.sift_max),
          static_cast<float>(config.ncc_nearly_best),
          static_cast<float>(config.sift_nearly_best),
          order_of(StereoFilter::ncc),
          order_of(StereoFilter::sift)};
}

/// Weight of full support by the neighbours relative to similarity; 0 without relaxation.
inline float support_weight(const StereoConfig& config) {
  return config.relaxation_rounds > 0 ? static_cast<float>(config.support_weight) : 0.0F;
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
  return {static_cast<float>(config.coarse_ncc_min),
          static_cast<float>(wide ? config.coarse_wide_sift_max : config.coarse_sift_max),
          static_cast<float>(config.coarse_ncc_nearly_best),
          static_cast<float>(config.coarse_sift_nearly_best),
          order_of(TemporalFilter::ncc),
          order_of(TemporalFilter::sift)};
}

inline QuadChoice quad_choice(const TemporalConfig& config, const TemporalSearch& search) {
  return {static_cast<float>(config.distance_weight) / (search.radius * search.radius),
          static_cast<float>(config.cluster_gap), static_cast<float>(config.cluster_orientation_rad())};
}

}  // namespace quadedge
