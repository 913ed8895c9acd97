#pragma once
/// \file tap.hpp  Observation of the production pipeline after every filter (doc/design.md section 3).

#include <cstdint>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

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

/// A search for the stereo edges of an earlier frame, the base, in the current frame.
struct ObservedSearch {
  int number =
      0;  ///< number among the searches of a frame, from 0; see TemporalMatches::search and FrameResult::search
  int base_frame = 0;         ///< number of the base; frames passed to StereoOdometry are counted from 0
  EdgePositions left, right;  ///< predicted position of every stereo edge of the base in the current images
  double radius = 0;          ///< search radius around the predicted positions [px]
  int step = 1;               ///< every step-th stereo edge of the base is searched for and has a row
};

/// Receives copies of the results of each stage, as computed by the production kernels. All functions do nothing by
/// default; overriding one makes the pipeline read the data back.
class Tap {
 public:
  virtual ~Tap() = default;
  /// Called after edge detection of a frame.
  virtual void edges(const EdgeSet& left, const EdgeSet& right) { (void)left, (void)right; }
  /// Called after every stereo filter between the baseline and the best. Rows are left edges, targets right edges.
  virtual void stereo_filter(StereoFilter filter, const CandidateLists& candidates) { (void)filter, (void)candidates; }
  /// Called with the final stereo edges of a frame.
  virtual void stereo(const StereoEdges& edges) { (void)edges; }
  /// Called before every temporal search.
  virtual void temporal_search(const ObservedSearch& search) { (void)search; }
  /// Called after every filter of that search between the baseline and the best, for the left and the right image. Row
  /// r is stereo edge r * step of the base; targets are current stereo edges. The quad agreement leaves one list, which
  /// is passed for both sides.
  virtual void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) {
    (void)filter, (void)side, (void)candidates;
  }
  /// Called with the quads of that search. FrameResult::search identifies the search that gave the frame's motion.
  virtual void quads(const TemporalMatches& matches) { (void)matches; }
};

}  // namespace quadedge
