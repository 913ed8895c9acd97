#pragma once
/// \file matching_result.hpp  Results of the matching evaluation; results of frames are added to those of sequences and
/// sets.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/cues.hpp"
#include "evaluation/filter_table.hpp"
#include "evaluation/quad_pairs.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::evaluation {

/// Class of a final stereo edge with a known true position.
enum class MatchClass {
  correct,     ///< within MatchingTolerance::position of the true position
  inaccurate,  ///< farther away, but within MatchingTolerance::wrong
  wrong,       ///< beyond MatchingTolerance::wrong
  occluded,    ///< the edge is not visible in the right view, so that its match must be another edge
};
inline constexpr std::array<const char*, 4> kMatchClassNames = {"correct", "inaccurate", "wrong", "occluded"};
using MatchClassCounts = std::array<std::int64_t, kMatchClassNames.size()>;

/// A final stereo edge [px, rad] and the true position of its left edge in the right image.
struct FinalMatch {
  float left_x, left_y, left_direction;
  float right_x, right_y, right_direction;
  float true_x, true_y;
  MatchClass kind;
};

/// Data for the drawing of one frame.
struct DrawnFrame {
  int number = 0;
  Image left, right;
  std::vector<FinalMatch> matches;
};

/// Ground truth of the left edges of a frame.
struct EdgeCensus {
  std::int64_t edges = 0;
  std::int64_t no_statement = 0;  ///< unknown disparity, or undetermined surface
  std::int64_t along_line = 0;    ///< known, but parallel to the epipolar line and therefore not matched
  std::int64_t occluded = 0;      ///< of the others: not visible in the right view
  std::int64_t contour = 0;       ///< of the others: on a depth step
};

/// Evaluation of the temporal search that gave the motion of a frame.
struct TemporalMatching {
  FilterTable left, right;  ///< Table 2
  FilterCounts quads_paired, quads_all;
  std::int64_t competing_paired = 0, competing_all = 0;  ///< competing clusters of the edges of a pool's quads
  PairMeasurement pairs;                                 ///< Table 3 and Figure 7

  FilterTable& table(Side side) { return side == Side::left ? left : right; }
};

/// One frame.
struct FrameMatching {
  FrameCounts counts;  ///< as reported by the pipeline
  FrameStatus status = FrameStatus::first;
  std::string message;  ///< as reported by the pipeline: why a frame was lost, or which capacity was exceeded
  FilterTable stereo;   ///< Table 1
  EdgeCensus census;
  /// Nothing for first and lost frames, single pairs, and if the true motion is unknown.
  std::optional<TemporalMatching> temporal;
  /// Error of the motion estimated since the frame that this one was matched with; for tracked frames.
  std::optional<MotionError> motion;
  /// Errors of final stereo edges with known, visible true position [px]: position along the epipolar line minus the
  /// true position, and the absolute component across the edge.
  std::vector<float> disparity_error, across_error;
  MatchClassCounts classes{};         ///< final stereo edges of the pool `all`
  std::vector<CueDistribution> cues;  ///< moved to the result at the end of the frame
};

/// One pair or one sequence.
struct MatchingResult {
  std::string name;
  std::vector<FrameMatching> frames;
  std::vector<CueDistribution> cues;  ///< over all frames
  std::optional<DrawnFrame> drawn;    ///< the frame selected by MatchingOptions
};

/// Standard deviations over frames (divided by N); NaN for fewer than two.
struct FilterSpread {
  double recall = 0, precision = 0, ambiguity = 0;
};

/// A row of a pooled table: sums of the counts, and standard deviations of recall, precision and mean ambiguity over
/// frames.
struct PooledRow {
  FilterRow row;
  FilterSpread paired_std, all_std;
};

/// Quads of one pool. Ambiguity is the mean number of competing clusters of the quad's previous edge.
struct PooledQuads {
  FilterCounts counts;
  double ambiguity_mean = 0;  ///< NaN without quads
  FilterSpread std;
};

/// A row of the pooled Table 3.
struct PooledConstraint {
  ConstraintCounts counts;
  double recall_std = 0, precision_std = 0;
};

/// Data of one or several results that tables and JSON contain.
struct MatchingSummary {
  std::vector<PooledRow> stereo, temporal_left, temporal_right;
  PooledQuads quads_paired, quads_all;
  std::array<PooledConstraint, kConstraintNames.size()> constraints{};
  double disparity_median = 0,
         disparity_p90 = 0;                  ///< of the absolute error [px]; NaN without stereo edges with ground truth
  double disparity_bias = 0;                 ///< median of the signed error [px]
  double across_median = 0, across_p90 = 0;  ///< of the component across the edge [px]
  EdgeCensus census;
  MatchClassCounts classes{};
  std::vector<CueDistribution> cues;
  int frames = 0, temporal_frames = 0;
};
MatchingSummary summarise(const std::vector<MatchingResult>& results);

}  // namespace quadedge::evaluation
