#pragma once
/// \file filter_table.hpp  Recall, precision and ambiguity after each filter (doc/method.md section 8, the paper's
/// Tables 1 and 2).

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// When a candidate counts as the true one, and when an edge has a counterpart at all.
struct MatchingTolerance {
  double position = 1.0;             ///< px from the true position: veridical
  double wrong = 10.0;               ///< px from the true position: beyond it a match is wrong, before only inaccurate
  double line = 0.5;                 ///< px from the epipolar line; counterparts in stereo
  double stereo_direction = 5.0;     ///< deg, modulo 180; counterparts in stereo
  double temporal_direction = 10.0;  ///< deg, modulo 180; counterparts in time
};

/// Which edges a table is about; one entry per row of the lists.
struct Pools {
  /// The paper's pool: visible edges that have a detected counterpart. Recall is 1 at the start by construction.
  std::vector<std::uint8_t> paired;
  /// Every edge whose true position is known, occluded ones included. A candidate of an occluded edge is never
  /// veridical.
  std::vector<std::uint8_t> all;
};

/// Sums over the edges of one pool; they add up over frames and pairs.
struct FilterCounts {
  std::int64_t pool = 0;   ///< edges
  std::int64_t found = 0;  ///< edges with a veridical candidate
  std::int64_t alive = 0;  ///< edges with any candidate
  std::int64_t candidates = 0;
  std::int64_t veridical = 0;        ///< candidates
  std::int64_t most_candidates = 0;  ///< of one edge

  void add_edge(std::int64_t candidates_of_edge, std::int64_t veridical_of_edge);
  void add(const FilterCounts& other);
  double recall() const;          ///< found / pool; NaN for an empty pool
  double precision() const;       ///< veridical / candidates; NaN without candidates
  double ambiguity_mean() const;  ///< candidates per edge that has any, minus 1; NaN without candidates
  double ambiguity_max() const;
};

/// One row of a table.
struct FilterRow {
  int order = 0;
  std::string filter;
  FilterCounts paired, all;
};
using FilterTable = std::vector<FilterRow>;

/// Adds `other` row by row. \throws UsageError when the rows are not the same filters.
void add(FilterTable& sum, const FilterTable& other);

/// Counts what a filter left. Candidates that carry a refined position are judged by it, others by the position of
/// their target.
FilterRow judge(int order, const std::string& filter, const CandidateLists& lists, const std::vector<float>& target_x,
                const std::vector<float>& target_y, const TruePositions& truth, const Pools& pools,
                const MatchingTolerance& tolerance);

/// Row 0: every edge is paired with every target, without writing the lists down.
FilterRow judge_baseline(const std::string& filter, const std::vector<float>& target_x,
                         const std::vector<float>& target_y, int image_height, const TruePositions& truth,
                         const Pools& pools, const MatchingTolerance& tolerance);

/// True within `tolerance.position` of edge i's true position; never for an edge that is occluded or unknown.
bool is_veridical(const TruePositions& truth, std::size_t i, double x, double y, const MatchingTolerance& tolerance);

}  // namespace quadedge::evaluation
