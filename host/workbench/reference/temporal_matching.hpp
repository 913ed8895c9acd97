#pragma once
/// \file temporal_matching.hpp  Plain C++ twins of stage 6: from predicted positions to quads, and the global
/// matching.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "common/layouts.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "reference/candidates.hpp"
#include "reference/stereo_matching.hpp"

namespace quadedge::reference {

// Plain C++ twin of kernels/point_index.cl: points sorted by cells of the image, so that the
// cost of a search is proportional to the number of points found.

/// Points sorted by cell, cells in rows, and within a cell by number.
struct PointIndex {
  int columns = 0, rows = 0;             ///< cells
  std::vector<std::int32_t> cell_first;  ///< columns * rows + 1
  std::vector<std::int32_t> order;       ///< numbers of the points in that order

  int column(float x) const {
    return static_cast<int>(std::clamp(x / kCellWidth, 0.0f, static_cast<float>(columns - 1)));
  }
  int row(float y) const { return static_cast<int>(std::clamp(y / kCellHeight, 0.0f, static_cast<float>(rows - 1))); }

  /// Calls `visit(number)` for every point in the cells that a square of half side `radius` around (x, y) touches, in
  /// their order.
  template <class Visit>
  void visit_square(float x, float y, float radius, const Visit& visit) const {
    const int first_column = column(x - radius), last_column = column(x + radius), last_row = row(y + radius);
    for (int r = row(y - radius); r <= last_row; ++r) {
      const auto begin = cell_first[static_cast<std::size_t>(r * columns + first_column)];
      const auto end = cell_first[static_cast<std::size_t>(r * columns + last_column + 1)];
      for (auto k = begin; k < end; ++k) visit(order[static_cast<std::size_t>(k)]);
    }
  }
};

/// Index of points in an image of width x height px; points outside it count to the nearest cell. `index` keeps its
/// memory.
void make_point_index(const std::vector<float>& xs, const std::vector<float>& ys, int width, int height,
                      PointIndex& index);

// Plain C++ twin of kernels/temporal_candidates.cl.

/// Filters 1 and 2 of doc/method.md section 4 in one image: current edges within `radius` [px] of the predicted
/// position and within `orientation` [rad, modulo a full turn] of the predicted direction. Row r belongs to predicted
/// edge r * row_step; targets are in the order of the point index.
Candidates temporal_candidates(const EdgePositionsView& predicted, const EdgePositionsView& current,
                               const PointIndex& index, float radius, float orientation, int row_step = 1);

// Plain C++ twin of kernels/temporal_quads.cl.

/// Closes the circle: a living left candidate stays if the right list of its row holds the same current edge alive.
/// Marks the others in `left.state`; returns per left candidate the mean of both NCC (valid where alive).
std::vector<float> temporal_agreement(const Candidates& left_candidates, CandidateScores& left,
                                      const Candidates& right_candidates, const CandidateScores& right);

/// The quad of every row: its most similar candidate, after subtracting distance_weight (d / radius)^2, where d is the
/// distance from the predicted left position. Along a curve of uniform appearance the prediction decides.
/// `competing_clusters` counts further groups of candidates that do not chain up with the winner's (doc/method.md
/// section 4, filter 8).
///
/// The paper's photometric refinement in time is left out: positions detected in both rigs are better than refined
/// ones, and in a search that a coarse motion guides it rejected nothing but true quads (rendered room: 70.7 % recall
/// at 98.2 % precision without it, 67.9 % at 98.2 % with it).
TemporalMatches temporal_best(const Candidates& candidates, const CandidateScores& scores,
                              const std::vector<float>& agreement, const StereoEdges& current,
                              const TemporalConfig& config, const TemporalSearch& search);

// Plain C++ twin of kernels/temporal_match.cl: the whole cascade in time.

/// What one image of both rigs holds; descriptions by the number of the stereo edge.
struct TemporalMatchSide {
  const EdgeDescriptions& base;
  const EdgeDescriptions& current;
  int width, height;  ///< of the image [px]
};

/// One image's candidates within the radius and the angle of the prediction, with their final states.
struct TemporalMatchLists {
  Candidates candidates;
  CandidateScores scores;  ///< of the left image: with what the agreement rejected
};

/// The quads of a search, and the intermediate results.
struct TemporalMatchResult {
  TemporalMatchLists left, right;
  TemporalMatches matches;
};

/// The cascade of doc/method.md section 4, with SIFT where the limits of the search ask for it: temporal_candidates()
/// and candidate_filters() in either image, then temporal_agreement() and temporal_best().
/// \param current the stereo edges that are searched
TemporalMatchResult temporal_match(const TemporalSearch& search, const StereoEdges& current,
                                   const TemporalMatchSide& left, const TemporalMatchSide& right,
                                   const TemporalConfig& config);

// Plain C++ twin of kernels/global_matching.cl.

/// Some stereo edges of one rig with their wide descriptors: every step-th.
struct WideEdges {
  const StereoEdges& edges;
  int step;
  std::vector<std::uint8_t> descriptors;  ///< kWideBytes each
};

/// Finds the earlier edges among the current ones, anywhere in the left image: the most similar one, if it is mutually
/// best and no match elsewhere is nearly as good (kWideRatio; "elsewhere": farther than
/// kWideNeighbourhood px). The matches' ncc is the cosine of the two descriptors; they have no competing
/// clusters.
TemporalMatches find_global_matches(const WideEdges& earlier, const WideEdges& current);

}  // namespace quadedge::reference
