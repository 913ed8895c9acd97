#pragma once
/// \file filter_table.hpp  Recall, precision and ambiguity after each filter (doc/method.md section 8, the paper's
/// Tables 1 and 2).

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// Criteria for veridical candidates, and for edges that have a counterpart.
struct MatchingTolerance {
  double position = 1.0;             ///< distance from the true position within which a candidate is veridical [px]
  double wrong = 10.0;               ///< distance beyond which a match is wrong; below, it is only inaccurate [px]
  double line = 0.5;                 ///< distance of stereo counterparts from the epipolar line [px]
  double stereo_direction = 5.0;     ///< for stereo counterparts [deg], modulo 180
  double temporal_direction = 10.0;  ///< for temporal counterparts [deg], modulo 180
};

/// Edges covered by a table; one entry per row of the lists.
struct Pools {
  /// The paper's pool: visible edges with a detected counterpart. The initial recall is 1 by construction.
  std::vector<std::uint8_t> paired;
  /// Every edge with a known true position, including occluded ones. Candidates of occluded edges are never veridical.
  std::vector<std::uint8_t> all;
};

/// Sums over the edges of one pool; can be added over frames and pairs.
struct FilterCounts {
  std::int64_t pool = 0;   ///< edges
  std::int64_t found = 0;  ///< edges with a veridical candidate
  std::int64_t alive = 0;  ///< edges with any candidate
  std::int64_t candidates = 0;
  std::int64_t veridical = 0;        ///< candidates
  std::int64_t most_candidates = 0;  ///< largest number of one edge

  void add_edge(std::int64_t candidates_of_edge, std::int64_t veridical_of_edge);
  void add(const FilterCounts& other);
  double recall() const;          ///< found / pool; NaN for an empty pool
  double precision() const;       ///< veridical / candidates; NaN without candidates
  double ambiguity_mean() const;  ///< mean number of candidates of edges that have any, minus 1; NaN without candidates
  double ambiguity_max() const;
};

/// One row of a table.
struct FilterRow {
  int order = 0;
  std::string filter;
  FilterCounts paired, all;
};
using FilterTable = std::vector<FilterRow>;

/// Adds `other` row by row. \throws UsageError if the rows belong to different filters
void add(FilterTable& sum, const FilterTable& other);

/// Evaluates the candidates left by a filter, at their refined positions if available, otherwise at the positions of
/// their targets.
FilterRow judge(int order, const std::string& filter, const CandidateLists& lists, const std::vector<float>& target_x,
                const std::vector<float>& target_y, const TruePositions& truth, const Pools& pools,
                const MatchingTolerance& tolerance);

/// Row 0: every edge is paired with every target, without creating the lists.
FilterRow judge_baseline(const std::string& filter, const std::vector<float>& target_x,
                         const std::vector<float>& target_y, int image_height, const TruePositions& truth,
                         const Pools& pools, const MatchingTolerance& tolerance);

/// Whether a position is within `tolerance.position` of edge i's true position; false for occluded and unknown edges.
bool is_veridical(const TruePositions& truth, std::size_t i, double x, double y, const MatchingTolerance& tolerance);

}  // namespace quadedge::evaluation
