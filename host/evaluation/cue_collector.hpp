#pragma once
/// \file cue_collector.hpp  Collects the cues of candidates from a tap, separated by ground truth.

#include <cstdint>
#include <functional>
#include <vector>

#include "evaluation/cue_distribution.hpp"
#include "evaluation/filter_table.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// Data that determine whether a candidate is veridical, and to which pools its row belongs.
struct CandidateTruth {
  const TruePositions& truth;
  const Pools& pools;
  const MatchingTolerance& tolerance;
  const std::vector<float>& target_x;  ///< positions of the targets [px]
  const std::vector<float>& target_y;
};

/// The value of a cue for row i and a target. NaN: no value.
using PairValue = std::function<double(std::size_t row, std::size_t target)>;

/// Collects a geometric cue for all candidates in the lists.
void collect_geometry(const CandidateLists& lists, const CandidateTruth& judge, const PairValue& value,
                      CueDistribution& cue);

/// Collects the scores stored in the lists.
void collect_scores(const CandidateLists& lists, const CandidateTruth& judge, CueDistribution& cue);

/// Collects the scores stored in the lists, relative to the best of each list: value / highest, or lowest / value.
void collect_ratios(const CandidateLists& lists, const CandidateTruth& judge, bool highest_is_best,
                    CueDistribution& cue);

/// Collects a cue before the first filter, when every row is paired with every target: all veridical pairs, and
/// kDrawnOthers of the others per row.
/// \param image_height height of the targets' image [px]
void collect_unfiltered(const CandidateTruth& judge, int image_height, std::uint64_t seed, const PairValue& value,
                        CueDistribution& cue);
inline constexpr int kDrawnOthers = 40;

}  // namespace quadedge::evaluation
