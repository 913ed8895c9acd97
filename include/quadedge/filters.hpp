#pragma once
/// \file filters.hpp  The filters of both cascades in their order, as the tables print them.

#include <cstdint>

namespace quadedge {

/// Stereo cascade; the value is the order of the paper's Table 1 (doc/method.md section 3).
enum class StereoFilter : std::uint8_t {
  baseline,  ///< every pair of edges
  epipolar_distance,
  disparity,
  orientation,
  sift,
  ncc,
  nearly_best_ncc,
  nearly_best_sift,
  refinement,  ///< along the epipolar line, with clustering
  similarity,  ///< of the clusters' representatives
  relaxation,  ///< of an edge's candidates the one that its neighbours agree with
  one_to_one,  ///< beside: what is left of these where no two left edges may share a right edge
  best         ///< best and mutual: neighbours may share a right edge
};

/// Temporal cascade; the value is the order of the paper's Table 2 (doc/method.md section 4). Each kind of search takes
/// SIFT where its limit is set.
enum class TemporalFilter : std::uint8_t {
  baseline,  ///< every pair of stereo edges
  displacement,
  orientation,
  ncc,
  sift,
  nearly_best_ncc,
  nearly_best_sift,
  agreement,  ///< of the left and the right images
  best
};

/// Place of a filter in its cascade: 0 is the baseline, the last one is `best`.
constexpr int order_of(StereoFilter filter) { return static_cast<int>(filter); }
constexpr int order_of(TemporalFilter filter) { return static_cast<int>(filter); }

/// The filter that judges what this one leaves; `best` has none.
template <class Filter>
constexpr Filter next(Filter filter) {
  return static_cast<Filter>(order_of(filter) + 1);
}

/// The name that tables print.
constexpr const char* to_string(StereoFilter filter) {
  switch (filter) {
    case StereoFilter::baseline: return "baseline";
    case StereoFilter::epipolar_distance: return "epipolar proximity";
    case StereoFilter::disparity: return "limited disparity";
    case StereoFilter::orientation: return "orientation";
    case StereoFilter::sift: return "SIFT";
    case StereoFilter::ncc: return "NCC";
    case StereoFilter::nearly_best_ncc: return "nearly best NCC";
    case StereoFilter::nearly_best_sift: return "nearly best SIFT";
    case StereoFilter::refinement: return "refinement and clustering";
    case StereoFilter::similarity: return "similarity of representatives";
    case StereoFilter::relaxation: return "relaxation";
    case StereoFilter::one_to_one: return "(strictly one-to-one)";
    case StereoFilter::best: return "best";
  }
  return "unknown";
}
constexpr const char* to_string(TemporalFilter filter) {
  switch (filter) {
    case TemporalFilter::baseline: return "baseline";
    case TemporalFilter::displacement: return "displacement";
    case TemporalFilter::orientation: return "orientation";
    case TemporalFilter::ncc: return "NCC";
    case TemporalFilter::sift: return "SIFT";
    case TemporalFilter::nearly_best_ncc: return "nearly best NCC";
    case TemporalFilter::nearly_best_sift: return "nearly best SIFT";
    case TemporalFilter::agreement: return "quad agreement";
    case TemporalFilter::best: return "best";
  }
  return "unknown";
}

}  // namespace quadedge
