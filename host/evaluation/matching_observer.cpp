#include "evaluation/matching_observer.hpp"

#include <cmath>

#include "common/filter_names.hpp"
#include "evaluation/pools.hpp"
#include "pose/quads.hpp"

namespace quadedge::evaluation {
namespace {

constexpr int kBestOrder = static_cast<int>(kStereoFilters.size()) - 1;
constexpr int kTemporalLastOrder = static_cast<int>(kTemporalFilters.size()) - 1;

/// The final stereo edges as lists over all left edges.
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

/// Matches as lists over all previous stereo edges, with the refined places in one image.
CandidateLists lists_of(const TemporalMatches& matches, std::size_t previous_edges, bool right) {
  CandidateLists lists;
  lists.first.assign(previous_edges + 1, 0);
  for (const auto previous : matches.previous) ++lists.first[static_cast<std::size_t>(previous) + 1];
  for (std::size_t i = 0; i < previous_edges; ++i) lists.first[i + 1] += lists.first[i];
  lists.target = matches.current;
  lists.x = right ? matches.right_x : matches.left_x;
  lists.y = right ? matches.right_y : matches.left_y;
  return lists;
}

/// What the truth says about a match; nothing for edges of unknown truth.
MatchClass classify(const TruePlaces& truth, std::size_t i, double x, double y, const MatchingTolerance& tolerance) {
  if (truth.state[i] == Visibility::hidden) return MatchClass::hidden;
  if (is_veridical(truth, i, x, y, tolerance)) return MatchClass::correct;
  return std::hypot(x - truth.x[i], y - truth.y[i]) <= tolerance.wrong ? MatchClass::inaccurate : MatchClass::wrong;
}

}  // namespace

MatchingObserver::MatchingObserver(const StereoRig& rig, const Config& config, const MatchingTolerance& tolerance,
                                   bool distributions)
    : rig_(rig), config_(config), tolerance_(tolerance) {
  if (distributions) empty_cues_ = make_cues(rig, config);
}

void MatchingObserver::begin(FrameTruth truth) {
  current_ = {};
  current_.truth = std::move(truth);
  measured_ = {};
  measured_.cues = empty_cues_;
  final_matches_.clear();
  complete_search_ = false;
}

FrameMatching MatchingObserver::end(const FrameResult& result) {
  measured_.counts = result.counts;
  measured_.status = result.status;
  measured_.message = result.message;
  current_.world_from_left = result.world_from_left;
  if (result.status == FrameStatus::tracked && is_known_motion()) {
    measured_.motion = motion_error(current_.world_from_left.inverse() * base_->world_from_left,
                                    current_.truth.world_from_left->inverse() * *base_->truth.world_from_left);
  }
  // The rule by which the pipeline chooses what the next frame is matched with.
  if (is_tracked(result.status) || result.new_key_rig) base_ = std::move(current_);
  return std::move(measured_);
}

void MatchingObserver::edges(const EdgeSet& left, const EdgeSet& right) {
  left_ = left;
  right_ = right;
  stereo_truth_ = true_right_places(rig_, current_.truth, {left.x, left.y, left.direction});
  stereo_pools_ = stereo_pools(rig_, left, right, stereo_truth_, config_.stereo.min_epipolar_angle, tolerance_);
  EdgeCensus& census = measured_.census;
  census.edges = static_cast<std::int64_t>(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const bool known = stereo_truth_.state[i] != Visibility::unknown, takes_part = stereo_pools_.all[i] != 0;
    census.no_statement += known ? 0 : 1;
    census.along_line += known && !takes_part ? 1 : 0;
    census.hidden += takes_part && stereo_truth_.state[i] == Visibility::hidden ? 1 : 0;
    census.contour += takes_part && stereo_truth_.contour[i] != 0 ? 1 : 0;
  }
  measured_.stereo.push_back(
      judge_baseline(kStereoFilters[0], right.x, right.y, rig_.right.height, stereo_truth_, stereo_pools_, tolerance_));
  collect_stereo(0, {});
}

void MatchingObserver::stereo_filter(int order, const std::string& name, const CandidateLists& candidates) {
  measured_.stereo.push_back(
      judge(order, name, candidates, right_.x, right_.y, stereo_truth_, stereo_pools_, tolerance_));
  collect_stereo(order, candidates);
}

void MatchingObserver::stereo(const StereoEdges& edges) {
  stereo_filter(kBestOrder, kStereoFilters.back(), lists_of(edges, left_.size()));
  current_.edges = edges;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto i = static_cast<std::size_t>(edges.left_index[k]);
    current_.veridical.push_back(is_veridical(stereo_truth_, i, edges.right_x[k], edges.right_y[k], tolerance_) ? 1
                                                                                                                : 0);
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

void MatchingObserver::temporal_search(const ExpectedEdges& left, const ExpectedEdges& right, double, int step) {
  complete_search_ =
      step == 1 && is_known_motion();  // a search that looks at a part of the edges only makes a prediction
  measured_.temporal_left.clear();
  measured_.temporal_right.clear();
  measured_.quads_paired = measured_.quads_all = {};
  measured_.quad_rivals = 0;
  measured_.pairs = {};
  for (auto& cue : measured_.cues) {  // of an earlier search
    if (cue.table != CueTable::stereo) cue = *find_cue(empty_cues_, cue.table, cue.order);
  }
  if (!complete_search_) return;
  expected_left_ = left;
  expected_right_ = right;
  start_temporal();
}

/// Truth and pools of the matching with the base, and row 0 of both tables.
void MatchingObserver::start_temporal() {
  const EdgePlaces previous{base_->edges.left_x, base_->edges.left_y, base_->edges.left_direction};
  later_left_ = true_later_places(rig_, base_->truth, current_.truth, false, previous);
  later_right_ = true_later_places(rig_, base_->truth, current_.truth, true, previous);
  const StereoEdges& now = current_.edges;
  left_pools_ = temporal_pools(base_->edges.left_direction, base_->veridical,
                               {now.left_x, now.left_y, now.left_direction}, rig_.left.height, later_left_, tolerance_);
  right_pools_ =
      temporal_pools(base_->edges.right_direction, base_->veridical, {now.right_x, now.right_y, now.right_direction},
                     rig_.right.height, later_right_, tolerance_);
  quad_pools_ =
      quad_pools(base_->edges, base_->veridical, now, rig_.left.height, later_left_, later_right_, tolerance_);
  const char* name = kTemporalFilters[0];
  measured_.temporal_left = {
      judge_baseline(name, now.left_x, now.left_y, rig_.left.height, later_left_, left_pools_, tolerance_)};
  measured_.temporal_right = {
      judge_baseline(name, now.right_x, now.right_y, rig_.right.height, later_right_, right_pools_, tolerance_)};
  collect_temporal(0, false, {});
  collect_temporal(0, true, {});
}

void MatchingObserver::temporal_filter(int order, const std::string& name, int side, const CandidateLists& candidates) {
  if (!complete_search_) return;
  const StereoEdges& now = current_.edges;
  const auto row = [&](bool right) {
    return right ? judge(order, name, candidates, now.right_x, now.right_y, later_right_, right_pools_, tolerance_)
                 : judge(order, name, candidates, now.left_x, now.left_y, later_left_, left_pools_, tolerance_);
  };
  // The agreement of both matchings leaves one list, which counts in both tables.
  const bool joint = order == kTemporalLastOrder - 1;
  if (side == 0 || joint) measured_.temporal_left.push_back(row(false));
  if (side == 1 || joint) measured_.temporal_right.push_back(row(true));
  collect_temporal(order, side == 1, candidates);
}

void MatchingObserver::quads(const TemporalMatches& matches) {
  if (!complete_search_) return;
  const std::size_t rows = base_->edges.size();
  const char* name = kTemporalFilters.back();
  const std::vector<float> none;
  measured_.temporal_left.push_back(judge(kTemporalLastOrder, name, lists_of(matches, rows, false), none, none,
                                          later_left_, left_pools_, tolerance_));
  measured_.temporal_right.push_back(judge(kTemporalLastOrder, name, lists_of(matches, rows, true), none, none,
                                           later_right_, right_pools_, tolerance_));
  measure_quads(matches);
}

/// The quads' own recall and precision, and pairs of them under the constraints.
void MatchingObserver::measure_quads(const TemporalMatches& matches) {
  const std::size_t rows = base_->edges.size();
  std::vector<std::uint8_t> known(matches.size(), 0), veridical(matches.size(), 0), candidates(rows, 0),
      true_candidates(rows, 0);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const auto i = static_cast<std::size_t>(matches.previous[k]);
    known[k] = quad_pools_.all[i];
    veridical[k] = is_veridical(later_left_, i, matches.left_x[k], matches.left_y[k], tolerance_) &&
                   is_veridical(later_right_, i, matches.right_x[k], matches.right_y[k], tolerance_);
    ++candidates[i];
    true_candidates[i] = static_cast<std::uint8_t>(true_candidates[i] + veridical[k]);
    if (quad_pools_.paired[i] != 0) measured_.quad_rivals += matches.rivals[k];
  }
  for (std::size_t i = 0; i < rows; ++i) {
    if (quad_pools_.all[i] != 0) measured_.quads_all.add_edge(candidates[i], true_candidates[i]);
    if (quad_pools_.paired[i] != 0) measured_.quads_paired.add_edge(candidates[i], true_candidates[i]);
  }
  const auto quads = pose::build_quads(rig_, base_->edges, current_.edges, matches, pose::QuadLimits(config_));
  std::vector<std::size_t> usable;  // quads of known truth
  std::vector<std::uint8_t> veridical_quad;
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const auto match = static_cast<std::size_t>(quads.match[q]);
    if (known[match] != 0) usable.push_back(q);
    veridical_quad.push_back(veridical[match]);
  }
  measured_.pairs =
      measure_pairs(quads, usable, veridical_quad, config_.pose, config_.seed,
                    current_.truth.world_from_left->inverse() * *base_->truth.world_from_left, measured_.cues);
}

}  // namespace quadedge::evaluation
