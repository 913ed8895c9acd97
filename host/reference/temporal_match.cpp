#include "reference/temporal_match.hpp"

#include <algorithm>

#include "common/matching_constants.hpp"
#include "reference/point_index.hpp"
#include "reference/temporal_candidates.hpp"
#include "reference/temporal_quads.hpp"

namespace quadedge::reference {
namespace {

/// Rows that kept a candidate.
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
TemporalMatchLists match_side(const EdgePositionsView& predicted, const EdgePositionsView& current,
                              const TemporalMatchSide& side, const TemporalSearch& search,
                              const TemporalConfig& config) {
  PointIndex index;
  make_point_index(current.x, current.y, side.width, side.height, index);
  TemporalMatchLists lists;
  lists.candidates = temporal_candidates(predicted, current, index, search.radius,
                                         static_cast<float>(kTemporalOrientation), search.step);
  lists.scores =
      candidate_filters(lists.candidates, side.base, side.current, temporal_limits(config, search), search.step);
  return lists;
}

}  // namespace

TemporalMatchResult temporal_match(const TemporalSearch& search, const StereoEdges& current,
                                   const TemporalMatchSide& left, const TemporalMatchSide& right,
                                   const TemporalConfig& config) {
  TemporalMatchResult result;
  result.left = match_side(search.left, current.positions(Side::left), left, search, config);
  result.right = match_side(search.right, current.positions(Side::right), right, search, config);
  const int alive_left = alive_rows(result.left), alive_right = alive_rows(result.right);
  const auto agreement =
      temporal_agreement(result.left.candidates, result.left.scores, result.right.candidates, result.right.scores);
  result.matches = temporal_best(result.left.candidates, result.left.scores, agreement, current, config, search);
  result.matches.alive_left = alive_left;
  result.matches.alive_right = alive_right;
  return result;
}

}  // namespace quadedge::reference
