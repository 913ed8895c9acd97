#pragma once
/// \file matching_result.hpp  What the evaluation of the matching measures; frames add up to sequences and pairs to sets.

#include <array>
#include <string>
#include <vector>

#include "evaluation/filter_table.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::evaluation {

/// Rows of Table 3: all pairs of quads, then the constraints of the paper's Equation 9 one after another.
inline constexpr std::array<const char*, 7> kConstraintNames = {
    "baseline", "length of D", "angle of D and T1", "angle of D and T2", "angle of T1 and T2", "D not along T1", "handedness"};

/// Pairs of quads that fulfil constraints 1 to `order`.
struct ConstraintCounts {
  std::int64_t pairs = 0, veridical = 0;
};
using ConstraintTable = std::array<ConstraintCounts, kConstraintNames.size()>;

/// What the ground truth says about the left edges of a frame.
struct EdgeCensus {
  std::int64_t edges = 0;
  std::int64_t no_statement = 0;  ///< unknown disparity, or no telling which surface owns the edge
  std::int64_t along_line = 0;    ///< known, but along the epipolar line: takes no part in stereo
  std::int64_t hidden = 0;        ///< of the others: not visible in the right view
  std::int64_t contour = 0;       ///< of the others: on a depth step
};

/// One frame.
struct FrameMatching {
  FrameCounts counts;                 ///< the pipeline's own
  FrameStatus status = FrameStatus::first;
  FilterTable stereo;                 ///< Table 1
  FilterTable temporal_left, temporal_right;  ///< Table 2; empty for the first frame and single pairs
  FilterCounts quads_paired, quads_all;
  std::int64_t quad_rivals = 0;       ///< further clusters that the paired quads' edges had
  EdgeCensus census;
  ConstraintTable constraints{};      ///< Table 3
  /// Final stereo edges whose truth is known and visible [px]: place along the epipolar line minus the true one, and the part of
  /// it that is across the edge, without sign.
  std::vector<float> disparity_error, across_error;
};

/// One pair or one sequence.
struct MatchingResult {
  std::string name;
  std::vector<FrameMatching> frames;
};

/// A row of a pooled table with the standard deviations of recall and precision over the frames (N, not N - 1).
struct PooledRow {
  FilterRow row;
  double paired_recall_std = 0, paired_precision_std = 0, all_recall_std = 0, all_precision_std = 0;
};

/// Everything that tables and JSON print of one or several results.
struct MatchingSummary {
  std::vector<PooledRow> stereo, temporal_left, temporal_right;
  FilterCounts quads_paired, quads_all;
  double quads_ambiguity_mean = 0;  ///< rivals per quad of the paired pool; NaN without quads
  ConstraintTable constraints{};
  double disparity_median = 0, disparity_p90 = 0;  ///< of the absolute error [px]; NaN without stereo edges of known truth
  double disparity_bias = 0;                       ///< median of the signed error [px]
  double across_median = 0, across_p90 = 0;        ///< of the part across the edge [px]
  EdgeCensus census;
  int frames = 0, temporal_frames = 0;
};
MatchingSummary summarise(const std::vector<MatchingResult>& results);

}  // namespace quadedge::evaluation
