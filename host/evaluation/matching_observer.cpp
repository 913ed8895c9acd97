#include "evaluation/matching_observer.hpp"

#include <algorithm>
#include <cmath>

#include "common/disparity_range.hpp"
#include "common/epipolar_geometry.hpp"
#include "common/matching_constants.hpp"
#include "evaluation/cues.hpp"
#include "evaluation/filter_table.hpp"
#include "pose/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge::evaluation {
namespace {

/// Converts the final stereo edges to lists over all left edges.
CandidateLists lists_of(const StereoEdges& edges, std::size_t left_edges) {
  CandidateLists lists;
  lists.first.assign(left_edges + 1, 0);
  for (const auto left : edges.left_index) ++lists.first[static_cast<std::size_t>(left) + 1];
  for (std::size_t i = 0; i < left_edges; ++i) lists.first[i + 1] += lists.first[i];
  lists.target = edges.right_index;  // stereo edges are in the order of their left edges
  lists.x = edges.right_x;
  lists.y = edges.right_y;
  return lists;
}

/// Converts matches to lists over all stereo edges of the base, with the positions in one image.
CandidateLists lists_of(const TemporalMatches& matches, std::size_t base_edges, Side side) {
  CandidateLists lists;
  lists.first.assign(base_edges + 1, 0);
  for (const auto previous : matches.previous) ++lists.first[static_cast<std::size_t>(previous) + 1];
  for (std::size_t i = 0; i < base_edges; ++i) lists.first[i + 1] += lists.first[i];
  lists.target = matches.current;
  lists.x = side == Side::left ? matches.left_x : matches.right_x;
  lists.y = side == Side::left ? matches.left_y : matches.right_y;
  return lists;
}

/// Class of a match; nothing for edges without ground truth.
MatchClass classify(const TruePositions& truth, std::size_t i, double x, double y, const MatchingTolerance& tolerance) {
  if (truth.state[i] == Visibility::occluded) return MatchClass::occluded;
  if (is_veridical(truth, i, x, y, tolerance)) return MatchClass::correct;
  return std::hypot(x - truth.x[i], y - truth.y[i]) <= tolerance.wrong ? MatchClass::inaccurate : MatchClass::wrong;
}

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

MatchingObserver::MatchingObserver(const StereoRig& rig, const Config& config, const MatchingTolerance& tolerance,
                                   bool distributions)
    : rig_(rig), config_(config), tolerance_(tolerance) {
  if (distributions) empty_cues_ = make_cues(rig, config);
}

void MatchingObserver::begin(int frame, FrameTruth truth) {
  frame_ = frame;
  frames_[frame] = {};
  current().truth = std::move(truth);
  measured_ = {};
  measured_.cues = empty_cues_;
  final_matches_.clear();
  searches_.clear();
  search_ = nullptr;
}

FrameMatching MatchingObserver::end(const FrameResult& result) {
  measured_.counts = result.counts;
  measured_.status = result.status;
  measured_.message = result.message;
  current().world_from_left = result.pose_or_prediction();
  const auto found = searches_.find(result.diagnostics.search);
  if (found != searches_.end()) {
    const ObservedFrame& base = frames_.at(found->second.base_frame);
    if (is_known_motion(base)) {
      measured_.motion = motion_error(current().world_from_left.inverse() * base.world_from_left,
                                      current().truth.world_from_left->inverse() * *base.truth.world_from_left);
    }
    measured_.temporal = std::move(found->second.measured);
    add(measured_.cues, found->second.cues);
  }
  // No later frame is matched with a frame before the key rig.
  frames_.erase(frames_.begin(), frames_.lower_bound(result.reference_frame));
  return std::move(measured_);
}

void MatchingObserver::edges(const EdgeSet& left, const EdgeSet& right) {
  left_ = left;
  right_ = right;
  stereo_truth_ = true_right_positions(rig_, current().truth, left.positions());
  stereo_pools_ = stereo_pools(rig_, left, right, stereo_truth_, kMinEpipolarAngleDeg, tolerance_);
  EdgeCensus& census = measured_.census;
  census.edges = static_cast<std::int64_t>(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const bool known = stereo_truth_.state[i] != Visibility::unknown, takes_part = stereo_pools_.all[i] != 0;
    census.no_statement += known ? 0 : 1;
    census.along_line += known && !takes_part ? 1 : 0;
    census.occluded += takes_part && stereo_truth_.state[i] == Visibility::occluded ? 1 : 0;
    census.contour += takes_part && stereo_truth_.contour[i] != 0 ? 1 : 0;
  }
  measured_.stereo.push_back(judge_baseline(to_string(StereoFilter::baseline), right.x, right.y, rig_.right.height,
                                            stereo_truth_, stereo_pools_, tolerance_));
  collect_stereo(StereoFilter::baseline, {});
}

void MatchingObserver::stereo_filter(StereoFilter filter, const CandidateLists& candidates) {
  measured_.stereo.push_back(judge(order_of(filter), to_string(filter), candidates, right_.x, right_.y, stereo_truth_,
                                   stereo_pools_, tolerance_));
  collect_stereo(filter, candidates);
}

void MatchingObserver::stereo(const StereoEdges& edges) {
  stereo_filter(StereoFilter::best, lists_of(edges, left_.size()));
  current().edges = edges;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto i = static_cast<std::size_t>(edges.left_index[k]);
    const bool veridical = is_veridical(stereo_truth_, i, edges.right_x[k], edges.right_y[k], tolerance_);
    current().veridical.push_back(veridical ? 1 : 0);
    if (stereo_pools_.all[i] != 0) {
      const MatchClass kind = classify(stereo_truth_, i, edges.right_x[k], edges.right_y[k], tolerance_);
      ++measured_.classes[static_cast<std::size_t>(kind)];
      final_matches_.push_back({edges.left_x[k], edges.left_y[k], edges.left_direction[k], edges.right_x[k],
                                edges.right_y[k], edges.right_direction[k], stereo_truth_.x[i], stereo_truth_.y[i],
                                kind});
    }
    if (stereo_truth_.state[i] != Visibility::visible) continue;
    const double dx = edges.right_x[k] - stereo_truth_.x[i], dy = edges.right_y[k] - stereo_truth_.y[i];
    const double angle = edges.right_direction[k];
    measured_.disparity_error.push_back(static_cast<float>(std::copysign(std::hypot(dx, dy), -dx)));
    measured_.across_error.push_back(static_cast<float>(std::abs(std::cos(angle) * dy - std::sin(angle) * dx)));
  }
}

void MatchingObserver::temporal_search(const ObservedSearch& search) {
  search_ = &searches_[search.number];
  search_->base_frame = search.base_frame;
  const ObservedFrame& base = frames_.at(search.base_frame);
  if (search.step != 1 || !is_known_motion(base)) return;
  search_->expected[0] = search.left;
  search_->expected[1] = search.right;
  search_->measured.emplace();
  search_->cues = empty_cues_;
  start_temporal(base, *search_);
}

/// Computes ground truth and pools of the matching with the base, and row 0 of both tables.
void MatchingObserver::start_temporal(const ObservedFrame& base, Search& search) {
  const StereoEdges& now = current().edges;
  for (const Side side : kSides) {
    const auto s = static_cast<std::size_t>(index_of(side));
    const EdgePositionsView targets = now.positions(side);
    search.later[s] = true_later_positions(rig_, base.truth, current().truth, side, base.edges.positions(Side::left));
    search.pools[s] = temporal_pools(base.edges.positions(side).direction, base.veridical, targets, camera(side).height,
                                     search.later[s], tolerance_);
    search.measured->table(side).push_back(judge_baseline(to_string(TemporalFilter::baseline), targets.x, targets.y,
                                                          camera(side).height, search.later[s], search.pools[s],
                                                          tolerance_));
    collect_temporal(TemporalFilter::baseline, side, {});
  }
  search.quad_pools =
      quad_pools(base.edges, base.veridical, now, rig_.left.height, search.later[0], search.later[1], tolerance_);
}

void MatchingObserver::judge_temporal(TemporalFilter filter, Side side, const CandidateLists& candidates) {
  const auto s = static_cast<std::size_t>(index_of(side));
  const EdgePositionsView targets = current().edges.positions(side);
  search_->measured->table(side).push_back(judge(order_of(filter), to_string(filter), candidates, targets.x, targets.y,
                                                 search_->later[s], search_->pools[s], tolerance_));
}

void MatchingObserver::temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) {
  if (!search_->measured) return;
  judge_temporal(filter, side, candidates);
  collect_temporal(filter, side, candidates);
}

void MatchingObserver::quads(const TemporalMatches& matches) {
  if (!search_->measured) return;
  const std::size_t rows = frames_.at(search_->base_frame).edges.size();
  for (const Side side : kSides) judge_temporal(TemporalFilter::best, side, lists_of(matches, rows, side));
  measure_quads(matches);
}

/// Evaluates recall and precision of the quads, and pairs of quads under the constraints.
void MatchingObserver::measure_quads(const TemporalMatches& matches) {
  const ObservedFrame& base = frames_.at(search_->base_frame);
  TemporalMatching& measured = *search_->measured;
  const std::size_t rows = base.edges.size();
  std::vector<std::uint8_t> known(matches.size(), 0), veridical(matches.size(), 0), candidates(rows, 0),
      true_candidates(rows, 0);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const auto i = static_cast<std::size_t>(matches.previous[k]);
    known[k] = search_->quad_pools.all[i];
    veridical[k] = is_veridical(search_->later[0], i, matches.left_x[k], matches.left_y[k], tolerance_) &&
                   is_veridical(search_->later[1], i, matches.right_x[k], matches.right_y[k], tolerance_);
    ++candidates[i];
    true_candidates[i] = static_cast<std::uint8_t>(true_candidates[i] + veridical[k]);
    if (search_->quad_pools.paired[i] != 0) measured.competing_paired += matches.competing_clusters[k];
    if (search_->quad_pools.all[i] != 0) measured.competing_all += matches.competing_clusters[k];
  }
  for (std::size_t i = 0; i < rows; ++i) {
    if (search_->quad_pools.all[i] != 0) measured.quads_all.add_edge(candidates[i], true_candidates[i]);
    if (search_->quad_pools.paired[i] != 0) measured.quads_paired.add_edge(candidates[i], true_candidates[i]);
  }
  const auto quads = pose::build_quads(rig_, base.edges, current().edges, matches, pose::QuadLimits());
  std::vector<std::size_t> usable;  // quads with ground truth
  std::vector<std::uint8_t> veridical_quad;
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const auto match = static_cast<std::size_t>(quads.match[q]);
    if (known[match] != 0) usable.push_back(q);
    veridical_quad.push_back(veridical[match]);
  }
  measured.pairs =
      measure_pairs(quads, usable, veridical_quad, config_.seed,
                    current().truth.world_from_left->inverse() * *base.truth.world_from_left, search_->cues);
}

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

MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config,
                                 const MatchingOptions& options) {
  if (device.is_reference() && !config.is_paper())
    throw UsageError("evaluate matching needs an OpenCL device, because the reference has no taps");
  config.odometry.key_rig = false;  // the tables refer to consecutive frames
  MatchingObserver observer(source.rig(), with_disparity_range(config, source.rig()), options.tolerance,
                            options.distributions);
  StereoOdometry odometry(source.rig(), device, config);
  odometry.set_tap(&observer);
  MatchingResult result;
  result.name = source.name();
  const int count = options.frames > 0 ? std::min(options.frames, source.frames()) : source.frames();
  const int drawn = std::min(options.draw_frame, count - 1);
  for (int number = 0; number < count; ++number) {
    TrueFrame frame = source.load(number);
    observer.begin(number, std::move(frame.truth));
    FrameMatching measured = observer.end(odometry.track(frame.frame.view()));
    add(result.cues, measured.cues);
    measured.cues = {};
    result.frames.push_back(std::move(measured));
    if (number == drawn) {
      result.drawn =
          DrawnFrame{number, std::move(frame.frame.left), std::move(frame.frame.right), observer.final_matches()};
    }
    if (options.progress) options.progress(number + 1, count);
  }
  return result;
}

}  // namespace quadedge::evaluation
