#include "evaluation/cue_collector.hpp"

#include <algorithm>
#include <random>

#include "evaluation/draw.hpp"
#include "evaluation/pools.hpp"

namespace quadedge::evaluation {
namespace {

/// Calls `visit(row, candidate, target, veridical)` for every candidate in a row of a pool.
template <class Visit>
void visit_candidates(const CandidateLists& lists, const CandidateTruth& judge, const Visit& visit) {
  const bool refined = lists.x.size() == lists.target.size();
  for (std::size_t i = 0; i + 1 < lists.first.size(); ++i) {
    if (judge.pools.all[i] == 0) continue;
    for (auto k = static_cast<std::size_t>(lists.first[i]); k < static_cast<std::size_t>(lists.first[i + 1]); ++k) {
      const auto target = static_cast<std::size_t>(lists.target[k]);
      const double x = refined ? lists.x[k] : judge.target_x[target], y = refined ? lists.y[k] : judge.target_y[target];
      visit(i, k, target, is_veridical(judge.truth, i, x, y, judge.tolerance));
    }
  }
}

/// Adds a value to the pools to which its row belongs; every paired edge also belongs to the pool `all`.
void add(double value, bool veridical, bool paired, CueDistribution& cue) {
  if (paired) (veridical ? cue.veridical : cue.other).add(value);
  (veridical ? cue.veridical_all : cue.other_all).add(value);
}

}  // namespace

void collect_geometry(const CandidateLists& lists, const CandidateTruth& judge, const PairValue& value,
                      CueDistribution& cue) {
  visit_candidates(lists, judge, [&](std::size_t row, std::size_t, std::size_t target, bool veridical) {
    add(value(row, target), veridical, judge.pools.paired[row] != 0, cue);
  });
}

void collect_scores(const CandidateLists& lists, const CandidateTruth& judge, CueDistribution& cue) {
  if (lists.cue.size() != lists.target.size()) return;
  visit_candidates(lists, judge, [&](std::size_t row, std::size_t candidate, std::size_t, bool veridical) {
    add(lists.cue[candidate], veridical, judge.pools.paired[row] != 0, cue);
  });
}

void collect_ratios(const CandidateLists& lists, const CandidateTruth& judge, bool highest_is_best,
                    CueDistribution& cue) {
  if (lists.cue.size() != lists.target.size()) return;
  visit_candidates(lists, judge, [&](std::size_t row, std::size_t candidate, std::size_t, bool veridical) {
    const auto begin = lists.cue.begin() + lists.first[row], end = lists.cue.begin() + lists.first[row + 1];
    const double own = lists.cue[candidate];
    const bool paired = judge.pools.paired[row] != 0;
    if (highest_is_best) {
      add(own / *std::max_element(begin, end), veridical, paired, cue);
    } else {
      const double best = *std::min_element(begin, end);
      add(own > 0 ? best / own : 1.0, veridical, paired, cue);
    }
  });
}

void collect_unfiltered(const CandidateTruth& judge, int image_height, std::uint64_t seed, const PairValue& value,
                        CueDistribution& cue) {
  if (judge.target_x.empty()) return;
  const NearbyTargets nearby(judge.target_x, judge.target_y, image_height);
  // Each kind of row has its own generator, so that their samples are independent.
  std::mt19937_64 of_paired(seed), of_others(seed + 1);
  for (std::size_t i = 0; i < judge.pools.all.size(); ++i) {
    if (judge.pools.all[i] == 0) continue;
    const bool paired = judge.pools.paired[i] != 0;
    std::mt19937_64& random = paired ? of_paired : of_others;
    if (judge.truth.state[i] == Visibility::visible) {
      nearby.visit(judge.truth.x[i], judge.truth.y[i], judge.tolerance.position,
                   [&](std::size_t target) { add(value(i, target), true, paired, cue); });
    }
    for (int n = 0; n < kDrawnOthers; ++n) {
      const std::size_t target = draw(random, judge.target_x.size());
      if (is_veridical(judge.truth, i, judge.target_x[target], judge.target_y[target], judge.tolerance)) continue;
      add(value(i, target), false, paired, cue);
    }
  }
}

}  // namespace quadedge::evaluation
