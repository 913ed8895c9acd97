#include "reference/temporal_match.hpp"

#include <algorithm>

#include "common/point_index.hpp"
#include "reference/temporal_candidates.hpp"
#include "reference/temporal_quads.hpp"

namespace quadedge::reference {
namespace {

int alive_rows(const TemporalMatchLists& lists) {
  int rows = 0;
  for (std::size_t row = 0; row + 1 < lists.candidates.first.size(); ++row) {
    const auto begin = lists.scores.state.begin() + lists.candidates.first[row],
               end = lists.scores.state.begin() + lists.candidates.first[row + 1];
    if (std::find(begin, end, kCandidateAlive) != end) ++rows;
  }
  return rows;
}

/// Filters 1 to 6 in one image.
TemporalMatchLists match_side(const PlacedEdges& predicted, const PlacedEdges& current, const TemporalMatchSide& side,
                              const TemporalSearch& search, const TemporalConfig& config) {
  PointIndex index;
  make_point_index(current.x, current.y, side.width, side.height, index);
  TemporalMatchLists lists;
  lists.candidates = temporal_candidates(predicted, current, index, search.radius,
                                         static_cast<float>(config.orientation_rad()), search.step);
  lists.scores =
      candidate_filters(lists.candidates, side.base, side.current, temporal_limits(config, search), search.step);
  lists.alive_rows = alive_rows(lists);
  return lists;
}

}  // namespace

TemporalMatchResult temporal_match(const TemporalSearch& search, const StereoEdges& current,
                                   const TemporalMatchSide& left, const TemporalMatchSide& right,
                                   const TemporalConfig& config) {
  TemporalMatchResult result;
  result.left = match_side(search.left, {current.left_x, current.left_y, current.left_direction}, left, search, config);
  result.right =
      match_side(search.right, {current.right_x, current.right_y, current.right_direction}, right, search, config);
  const auto agreement =
      temporal_agreement(result.left.candidates, result.left.scores, result.right.candidates, result.right.scores);
  result.matches = temporal_best(result.left.candidates, result.left.scores, agreement, current, config, search);
  return result;
}

}  // namespace quadedge::reference
