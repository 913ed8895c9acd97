#pragma once
/// \file cue_collector.hpp  Reads the cues of candidates from what a tap sees, and sorts them by the ground truth.

#include <cstdint>
#include <functional>
#include <vector>

#include "evaluation/cue_distribution.hpp"
#include "evaluation/filter_table.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// What decides whether a candidate is veridical, and to which pools its row belongs.
struct CandidateTruth {
  const TruePositions& truth;
  const Pools& pools;
  const MatchingTolerance& tolerance;
  const std::vector<float>& target_x;  ///< positions of the targets [px]
  const std::vector<float>& target_y;
};

/// The value of a cue for row i and a target. NaN: no value.
using PairValue = std::function<double(std::size_t row, std::size_t target)>;

/// A cue of the geometry over all candidates of the lists.
void collect_geometry(const CandidateLists& lists, const CandidateTruth& judge, const PairValue& value,
                      CueDistribution& cue);

/// The cue that the lists carry, as it is.
void collect_scores(const CandidateLists& lists, const CandidateTruth& judge, CueDistribution& cue);

/// The cue that the lists carry, set in relation to the best of each list: value / highest, or lowest / value.
void collect_ratios(const CandidateLists& lists, const CandidateTruth& judge, bool highest_is_best,
                    CueDistribution& cue);

/// A cue before the first filter, where every row is paired with every target: the veridical pairs all, of the others
/// kDrawnOthers per row.
/// \param image_height of the targets' image [px]
void collect_unfiltered(const CandidateTruth& judge, int image_height, std::uint64_t seed, const PairValue& value,
                        CueDistribution& cue);
inline constexpr int kDrawnOthers = 40;

}  // namespace quadedge::evaluation
