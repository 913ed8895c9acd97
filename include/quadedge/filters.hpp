#pragma once
/// \file filters.hpp  The filters of the stereo and the temporal cascade, and the candidates that they leave.

#include <cstdint>
#include <vector>

namespace quadedge {

/// Stereo cascade; the value is the position in the paper's Table 1 (doc/method.md section 3).
enum class StereoFilter : std::uint8_t {
  baseline,  ///< all pairs of edges
  epipolar_distance,
  disparity,
  orientation,
  sift,
  ncc,
  nearly_best_ncc,
  nearly_best_sift,
  refinement,  ///< refinement along the epipolar line, and clustering
  similarity,  ///< NCC of the clusters' representatives
  relaxation,  ///< of an edge's candidates, the one that agrees with its neighbours
  one_to_one,  ///< for comparison only: what would remain if no two left edges could share a right edge
  best         ///< best and mutual; neighbours may share a right edge
};

/// Temporal cascade; the value is the position in the paper's Table 2 (doc/method.md section 4). A search uses the SIFT
/// filters if their limits are set.
enum class TemporalFilter : std::uint8_t {
  baseline,  ///< all pairs of stereo edges
  displacement,
  orientation,
  ncc,
  sift,
  nearly_best_ncc,
  nearly_best_sift,
  refinement,  ///< free refinement and clustering; only in the paper's method
  agreement,   ///< of the left and right images
  best
};

/// Position of a filter in its cascade: 0 is the baseline, the last is `best`.
constexpr int order_of(StereoFilter filter) { return static_cast<int>(filter); }
constexpr int order_of(TemporalFilter filter) { return static_cast<int>(filter); }

/// The filter that follows; `best` has none.
template <class Filter>
constexpr Filter next(Filter filter) {
  return static_cast<Filter>(order_of(filter) + 1);
}

/// Name in tables.
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
    case TemporalFilter::refinement: return "refinement and clustering";
    case TemporalFilter::agreement: return "quad agreement";
    case TemporalFilter::best: return "best";
  }
  return "unknown";
}

/// Candidate lists in compressed rows: row i consists of first[i] .. first[i + 1] - 1 of the flat arrays.
struct CandidateLists {
  std::vector<std::int32_t> first;   ///< size: rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
  std::vector<float> x, y;           ///< refined positions of the candidates [px]; empty: the positions of the targets
  /// The quantity that the NEXT filter compares with its threshold: NCC or SIFT distance. Empty if it uses positions or
  /// directions.
  std::vector<float> cue;
};

}  // namespace quadedge
