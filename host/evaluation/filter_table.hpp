#pragma once
/// \file filter_table.hpp  Which edges have a counterpart; recall, precision and ambiguity after each filter
/// (doc/method.md section 8, the paper's Tables 1 and 2).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"
#include "reference/temporal_matching.hpp"

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
  double precisions = 0;             ///< sum over the edges with candidates

  void add_edge(std::int64_t candidates_of_edge, std::int64_t veridical_of_edge);
  void add(const FilterCounts& other);
  double recall() const;     ///< found / pool; NaN for an empty pool
  double precision() const;  ///< veridical / candidates; NaN without candidates
  /// Mean over the edges with candidates, as in the program of the paper's authors; NaN without candidates.
  double precision_per_edge() const;
  double ambiguity_mean() const;  ///< mean number of candidates of edges that have any, minus 1; NaN without candidates
  double ambiguity_of_pool() const;  ///< candidates / pool - 1, as the paper defines it
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

/// Finds the edges of an image near a position.
class NearbyTargets {
 public:
  /// The arrays must outlive the object. `height`: of the image [px].
  NearbyTargets(const std::vector<float>& x, const std::vector<float>& y, int height) : x_(x), y_(y) {
    const float right_end = x.empty() ? 0 : *std::max_element(x.begin(), x.end());
    reference::make_point_index(x, y, std::max(1, static_cast<int>(std::ceil(right_end)) + 1), height, index_);
  }

  /// Calls `found(index)` for every target within `radius` px of the position.
  template <class Found>
  void visit(double x, double y, double radius, const Found& found) const {
    constexpr float kRounding = 0.01F;
    index_.visit_square(static_cast<float>(x), static_cast<float>(y), static_cast<float>(radius) + kRounding,
                        [&](std::int32_t number) {
                          const auto j = static_cast<std::size_t>(number);
                          if (std::hypot(x_[j] - x, y_[j] - y) <= radius) found(j);
                        });
  }

 private:
  const std::vector<float>& x_;
  const std::vector<float>& y_;
  reference::PointIndex index_;
};

/// Angle between two directions modulo a half turn [deg].
double line_angle_deg(double a, double b);

/// Pools of stereo matching. Edges with an angle below `min_epipolar_angle` [deg] to their epipolar line belong to
/// neither pool, because they are not matched. An edge is paired if it is visible and a right edge lies within the
/// tolerances of its true position, its epipolar line and its direction.
Pools stereo_pools(const StereoRig& rig, const EdgeSet& left, const EdgeSet& right, const TruePositions& truth,
                   double min_epipolar_angle, const MatchingTolerance& tolerance);

/// Pools of temporal matching within one image. An edge is paired if it is visible, its stereo edge is veridical, and a
/// current stereo edge lies within the tolerances of its true position and its previous direction.
/// \param previous_is_veridical one entry per previous stereo edge
Pools temporal_pools(const std::vector<float>& previous_direction,
                     const std::vector<std::uint8_t>& previous_is_veridical, const EdgePositionsView& current,
                     int image_height, const TruePositions& truth, const MatchingTolerance& tolerance);

/// Pools of quads: an edge is paired if ONE current stereo edge is the counterpart in both images.
Pools quad_pools(const StereoEdges& previous, const std::vector<std::uint8_t>& previous_is_veridical,
                 const StereoEdges& current, int image_height, const TruePositions& left_truth,
                 const TruePositions& right_truth, const MatchingTolerance& tolerance);

}  // namespace quadedge::evaluation
