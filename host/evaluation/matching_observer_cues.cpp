/// \file matching_observer_cues.cpp  Collects the cues of each filter.
#include <algorithm>
#include <cmath>

#include "common/epipolar_geometry.hpp"
#include "evaluation/cue_collector.hpp"
#include "evaluation/matching_observer.hpp"
#include "evaluation/pools.hpp"
#include "quadedge/pi.hpp"

namespace quadedge::evaluation {
namespace {

/// Adds the NCC or SIFT distance of the lists, as used by `filter`.
template <class Filter>
void collect_similarity(Filter filter, const CandidateLists& lists, const CandidateTruth& judge, CueDistribution& cue) {
  if (filter == Filter::nearly_best_ncc || filter == Filter::nearly_best_sift) {
    collect_ratios(lists, judge, filter == Filter::nearly_best_ncc, cue);
  } else {
    collect_scores(lists, judge, cue);
  }
}

double direction_difference_deg(double a, double b) { return std::abs(std::remainder(a - b, 2 * kPi)) * 180 / kPi; }

}  // namespace

/// Collects the cue of the filter that follows `filter`.
void MatchingObserver::collect_stereo(StereoFilter filter, const CandidateLists& candidates) {
  CueDistribution* found = find_cue(measured_.cues, CueTable::stereo, order_of(next(filter)));
  if (found == nullptr) return;
  const CandidateTruth judge{stereo_truth_, stereo_pools_, tolerance_, right_.x, right_.y};
  const auto geometry = make_epipolar_geometry(rig_, config_.stereo);
  const auto line_of = [&](std::size_t row) { return epipolar_line(geometry, left_.x[row], left_.y[row]); };
  if (filter == StereoFilter::baseline) {
    collect_unfiltered(
        judge, rig_.right.height, config_.seed,
        [&](std::size_t row, std::size_t target) {
          const auto line = line_of(row);
          return static_cast<double>(
              std::abs((right_.y[target] - line.y) * line.ex - (right_.x[target] - line.x) * line.ey));
        },
        *found);
  } else if (filter == StereoFilter::epipolar_distance) {
    collect_geometry(
        candidates, judge,
        [&](std::size_t row, std::size_t target) {
          const auto line = line_of(row);
          return static_cast<double>((right_.x[target] - line.x) * line.ex + (right_.y[target] - line.y) * line.ey);
        },
        *found);
  } else if (filter == StereoFilter::disparity) {
    collect_geometry(
        candidates, judge,
        [&](std::size_t row, std::size_t target) {
          return line_angle_deg(left_.direction[row], right_.direction[target]);
        },
        *found);
  } else {
    collect_similarity(next(filter), candidates, judge, *found);
  }
}

/// The same for the temporal search in progress.
void MatchingObserver::collect_temporal(TemporalFilter filter, Side side, const CandidateLists& candidates) {
  const CueTable table = side == Side::left ? CueTable::temporal_left : CueTable::temporal_right;
  CueDistribution* found = find_cue(search_->cues, table, order_of(next(filter)));
  if (found == nullptr) return;
  const auto s = static_cast<std::size_t>(index_of(side));
  const EdgePositionsView now = current().edges.positions(side);
  const EdgePositions& expected = search_->expected[s];
  const CandidateTruth judge{search_->later[s], search_->pools[s], tolerance_, now.x, now.y};
  if (filter == TemporalFilter::baseline) {
    collect_unfiltered(
        judge, camera(side).height, config_.seed,
        [&](std::size_t row, std::size_t target) {
          return static_cast<double>(std::hypot(now.x[target] - expected.x[row], now.y[target] - expected.y[row]));
        },
        *found);
  } else if (filter == TemporalFilter::displacement) {
    collect_geometry(
        candidates, judge,
        [&](std::size_t row, std::size_t target) {
          return direction_difference_deg(expected.direction[row], now.direction[target]);
        },
        *found);
  } else {
    collect_similarity(next(filter), candidates, judge, *found);
  }
}

}  // namespace quadedge::evaluation
