#include "evaluation/cues.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "common/filter_limits.hpp"
#include "common/matching_constants.hpp"
#include "evaluation/filter_table.hpp"
#include "pose/pose_constants.hpp"
#include "quadedge/error.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {
namespace {

constexpr double kSimilarityLow = -1, kSimilarityHigh = 1,
                 kSiftHigh = 800;  // upper limit for descriptors of norm 512

constexpr double kRounding = 1e-3;  // bins; in single precision, an NCC of one may slightly exceed one

/// Range of values that a filter keeps, and the bins that display its cue.
struct Range {
  double low, high;
  int bins;
};

CueDistribution make_cue(CueTable table, int order, const std::string& cue, const std::string& unit, bool keeps_small,
                         const std::vector<double>& thresholds, const Range& range, bool sampled = false) {
  const Histogram empty(range.low, range.high, range.bins);
  return {table, order, cue, unit, keeps_small, sampled, thresholds, empty, empty, empty, empty};
}

const Range kNcc{kSimilarityLow, kSimilarityHigh, 100}, kSift{0, kSiftHigh, 100}, kRatio{0, 1, 100};

/// The cues of NCC and SIFT, in the order of their cascade.
template <class Filter>
void add_similarities(CueTable table, double ncc_min, double sift_max, double ncc_nearly_best, double sift_nearly_best,
                      std::vector<CueDistribution>& cues) {
  const auto ncc = make_cue(table, order_of(Filter::ncc), "NCC", "", false, {ncc_min}, kNcc);
  const bool uses_sift = sift_max > 0;  // 0: without SIFT
  const auto sift = make_cue(table, order_of(Filter::sift), "SIFT distance", "", true,
                             uses_sift ? std::vector<double>{sift_max} : std::vector<double>{}, kSift);
  cues.push_back(Filter::ncc < Filter::sift ? ncc : sift);
  cues.push_back(Filter::ncc < Filter::sift ? sift : ncc);
  cues.push_back(
      make_cue(table, order_of(Filter::nearly_best_ncc), "NCC / best NCC", "", false, {ncc_nearly_best}, kRatio));
  cues.push_back(make_cue(table, order_of(Filter::nearly_best_sift), "best SIFT / SIFT distance", "", false,
                          uses_sift ? std::vector<double>{sift_nearly_best} : std::vector<double>{}, kRatio));
}

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

void Histogram::add(double value) {
  if (std::isnan(value)) return;
  const double bin = (value - low) / width();
  if (bin < -kRounding) {
    ++below;
  } else if (bin > static_cast<double>(bins.size()) + kRounding) {
    ++above;
  } else {
    ++bins[std::min(static_cast<std::size_t>(std::max(bin, 0.0)), bins.size() - 1)];
  }
}

void Histogram::add(const Histogram& other) {
  if (other.low != low || other.high != high || other.bins.size() != bins.size()) {
    throw UsageError("histograms of different bins cannot be pooled");
  }
  for (std::size_t i = 0; i < bins.size(); ++i) bins[i] += other.bins[i];
  below += other.below;
  above += other.above;
}

std::int64_t Histogram::total() const {
  std::int64_t sum = below + above;
  for (const auto count : bins) sum += count;
  return sum;
}

std::vector<CueDistribution> make_cues(const StereoRig& rig, const Config& config) {
  std::vector<CueDistribution> cues;
  const auto& stereo = config.stereo;
  const bool rectified = rig.right_from_left.linear().isIdentity(1e-9) && rig.left.fx == rig.right.fx;
  std::vector<double> disparity;
  if (stereo.max_disparity > 0) {
    disparity = {stereo.max_disparity};
  } else if (stereo.min_depth > 0 && rectified) {
    disparity = {rig.left.fx * rig.baseline() / stereo.min_depth};
  }
  const auto table = CueTable::stereo;
  cues.push_back(make_cue(table, order_of(StereoFilter::epipolar_distance), "distance from the epipolar line", "px",
                          true, {stereo.epipolar_distance}, {0, 5, 100}, true));
  cues.push_back(
      make_cue(table, order_of(StereoFilter::disparity), "disparity", "px", true, disparity, {-20, 480, 500}));
  cues.push_back(make_cue(table, order_of(StereoFilter::orientation), "difference of directions", "deg", true,
                          {stereo.orientation}, {0, 90, 180}));
  add_similarities<StereoFilter>(table, stereo.ncc_min, stereo.sift_max, stereo.ncc_nearly_best, kSiftNearlyBest, cues);
  cues.push_back(make_cue(table, order_of(StereoFilter::similarity), "similarity of representatives", "", false,
                          {static_cast<double>(lowest_similarity(stereo))}, kNcc));

  const auto& temporal = config.temporal;
  for (const auto side : {CueTable::temporal_left, CueTable::temporal_right}) {
    cues.push_back(make_cue(side, order_of(TemporalFilter::displacement), "distance from the expected position", "px",
                            true, {temporal.radius}, {0, 50, 200}, true));
    cues.push_back(make_cue(side, order_of(TemporalFilter::orientation), "difference of directions", "deg", true,
                            {kTemporalOrientationDeg}, {0, 180, 360}));
    add_similarities<TemporalFilter>(side, temporal.ncc_min, temporal.sift_max, temporal.ncc_nearly_best,
                                     temporal.sift_nearly_best, cues);
  }

  const auto pairs = CueTable::constraints;
  cues.push_back(make_cue(pairs, 1, "relative difference of |D|", "", true, {pose::kLengthDifference}, {0, 1, 200}));
  cues.push_back(make_cue(pairs, 2, "difference of cos(D, T1)", "", true, {pose::kAngleDifference}, {0, 2, 200}));
  cues.push_back(make_cue(pairs, 3, "difference of cos(D, T2)", "", true, {pose::kAngleDifference}, {0, 2, 200}));
  cues.push_back(make_cue(pairs, 4, "difference of T1 . T2", "", true, {pose::kTangentDifference}, {0, 2, 200}));
  cues.push_back(make_cue(pairs, 5, "angle between D and T1", "deg", false, {pose::kMinAngleDeg}, {0, 90, 90}));
  return cues;
}

void add(std::vector<CueDistribution>& sum, const std::vector<CueDistribution>& other) {
  if (sum.empty()) {
    sum = other;
    return;
  }
  for (const auto& cue : other) {
    CueDistribution* own = find_cue(sum, cue.table, cue.order);
    if (own == nullptr) throw UsageError("cues of different filters cannot be pooled");
    own->veridical.add(cue.veridical);
    own->other.add(cue.other);
    own->veridical_all.add(cue.veridical_all);
    own->other_all.add(cue.other_all);
    for (const double threshold : cue.thresholds) {
      auto& known = own->thresholds;
      if (std::find(known.begin(), known.end(), threshold) == known.end()) known.push_back(threshold);
    }
  }
}

CueDistribution* find_cue(std::vector<CueDistribution>& cues, CueTable table, int order) {
  for (auto& cue : cues) {
    if (cue.table == table && cue.order == order) return &cue;
  }
  return nullptr;
}

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
