/// \file matching_observer_cues.cpp  Which cue the observer reads where.
#include <algorithm>
#include <cmath>

#include "common/epipolar_geometry.hpp"
#include "common/filter_names.hpp"
#include "evaluation/cue_collector.hpp"
#include "evaluation/matching_observer.hpp"
#include "evaluation/pools.hpp"

namespace quadedge::evaluation {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kRepresentativesOrder = static_cast<int>(kStereoFilters.size()) - 2;

/// Adds the NCC or SIFT distance that lists carry, as filter `order` judges it.
void collect_similarity(int order, int ncc_order, int sift_order, const CandidateLists& lists,
                        const CandidateTruth& judge, CueDistribution& cue) {
  const int nearly_best_ncc = std::max(ncc_order, sift_order) + 1;
  if (order == nearly_best_ncc || order == nearly_best_ncc + 1) {
    collect_shares(lists, judge, order == nearly_best_ncc, cue);
  } else {
    collect_scores(lists, judge, cue);
  }
}

double direction_difference_deg(double a, double b) { return std::abs(std::remainder(a - b, 2 * kPi)) * 180 / kPi; }

}  // namespace

CueDistribution* MatchingObserver::cue(CueTable table, int order) { return find_cue(measured_.cues, table, order); }

/// What the filter after `order` judges.
void MatchingObserver::collect_stereo(int order, const CandidateLists& candidates) {
  CueDistribution* found = cue(CueTable::stereo, order + 1);
  if (found == nullptr) return;
  const CandidateTruth judge{stereo_truth_, stereo_pools_, tolerance_, right_.x, right_.y};
  const auto geometry = make_epipolar_geometry(rig_, config_.stereo);
  const auto line_of = [&](std::size_t row) { return epipolar_line(geometry, left_.x[row], left_.y[row]); };
  if (order == 0) {
    collect_unfiltered(
        judge, rig_.right.height, config_.seed,
        [&](std::size_t row, std::size_t target) {
          const auto line = line_of(row);
          return static_cast<double>(
              std::abs((right_.y[target] - line.y) * line.ex - (right_.x[target] - line.x) * line.ey));
        },
        *found);
  } else if (order == 1) {
    collect_geometry(
        candidates, judge,
        [&](std::size_t row, std::size_t target) {
          const auto line = line_of(row);
          return static_cast<double>((right_.x[target] - line.x) * line.ex + (right_.y[target] - line.y) * line.ey);
        },
        *found);
  } else if (order == 2) {
    collect_geometry(
        candidates, judge,
        [&](std::size_t row, std::size_t target) {
          return line_angle_deg(left_.direction[row], right_.direction[target]);
        },
        *found);
  } else if (order + 1 == kRepresentativesOrder) {
    collect_scores(candidates, judge, *found);
  } else {
    collect_similarity(order + 1, kStereoNccOrder, kStereoSiftOrder, candidates, judge, *found);
  }
}

void MatchingObserver::collect_temporal(int order, bool right, const CandidateLists& candidates) {
  CueDistribution* found = cue(right ? CueTable::temporal_right : CueTable::temporal_left, order + 1);
  if (found == nullptr) return;
  const StereoEdges& now = current_.edges;
  const auto &x = right ? now.right_x : now.left_x, &y = right ? now.right_y : now.left_y;
  const auto& direction = right ? now.right_direction : now.left_direction;
  const ExpectedEdges& expected = right ? expected_right_ : expected_left_;
  const CandidateTruth judge{right ? later_right_ : later_left_, right ? right_pools_ : left_pools_, tolerance_, x, y};
  if (order == 0) {
    const int height = right ? rig_.right.height : rig_.left.height;
    collect_unfiltered(
        judge, height, config_.seed,
        [&](std::size_t row, std::size_t target) {
          return static_cast<double>(std::hypot(x[target] - expected.x[row], y[target] - expected.y[row]));
        },
        *found);
  } else if (order == 1) {
    collect_geometry(
        candidates, judge,
        [&](std::size_t row, std::size_t target) {
          return direction_difference_deg(expected.direction[row], direction[target]);
        },
        *found);
  } else {
    collect_similarity(order + 1, kTemporalNccOrder, kTemporalSiftOrder, candidates, judge, *found);
  }
}

}  // namespace quadedge::evaluation
