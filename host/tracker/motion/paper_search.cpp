/// \file paper_search.cpp  Continues quads through adjacent frames to the keyframe, then RANSAC and a fit to inliers.
#include "motion/paper_search.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/matching_constants.hpp"
#include "common/timing.hpp"
#include "motion/paper_consensus.hpp"

namespace quadedge::odometry {
namespace {

/// The current edges of the matches, one per match, where the refinement put them.
StereoEdges refined_edges(const TemporalMatches& matches) {
  StereoEdges edges;
  edges.left_index = matches.current;
  edges.left_x = matches.left_x;
  edges.left_y = matches.left_y;
  edges.left_direction = matches.left_direction;
  edges.right_x = matches.right_x;
  edges.right_y = matches.right_y;
  edges.right_direction = matches.right_direction;
  return edges;
}

}  // namespace

TemporalMatches propagate(const TemporalMatches& from_key, const TemporalMatches& from_earlier) {
  TemporalMatches result;
  result.search = from_earlier.search;
  result.alive_left = from_earlier.alive_left;
  result.alive_right = from_earlier.alive_right;
  const std::vector<std::int32_t>& starts = from_earlier.previous;  // ascending
  for (std::size_t k = 0, begin = 0; k < from_key.size(); ++k) {
    if (k > 0 && from_key.previous[k] != from_key.previous[k - 1]) begin = result.size();
    const auto continued = std::equal_range(starts.begin(), starts.end(), from_key.current[k]);
    for (auto start = continued.first; start != continued.second; ++start) {
      const auto i = static_cast<std::size_t>(start - starts.begin());
      const auto first_of_edge = result.current.begin() + static_cast<std::ptrdiff_t>(begin);
      if (std::find(first_of_edge, result.current.end(), from_earlier.current[i]) != result.current.end()) continue;
      result.previous.push_back(from_key.previous[k]);
      result.current.push_back(from_earlier.current[i]);
      for (auto column :
           {&TemporalMatches::left_x, &TemporalMatches::left_y, &TemporalMatches::right_x, &TemporalMatches::right_y,
            &TemporalMatches::left_direction, &TemporalMatches::right_direction, &TemporalMatches::ncc})
        (result.*column).push_back((from_earlier.*column)[i]);
    }
  }
  for (const std::int32_t edge : result.previous) {
    const auto own = std::equal_range(result.previous.begin(), result.previous.end(), edge);
    result.competing_clusters.push_back(static_cast<std::int32_t>(own.second - own.first) - 1);
  }
  return result;
}

StepHandle PaperSearch::new_step(const MotionQuery& query, const frontend::FrameEdgesHandle& base) {
  StepHandle step = steps_.acquire();
  step->base = base;
  step->rig = query.rig;
  return step;
}

StepHandle PaperSearch::find(const MotionQuery& query) {
  current_ = query.current;
  StepHandle adjacent = new_step(query, query.base);
  frontend_.match(*query.base, *query.current, {}, adjacent->matches);
  if (query.key && query.key->frame == chain_key_ && query.base->frame == chain_end_) {
    StepHandle by_key = new_step(query, query.key);
    by_key->matches = propagate(chain_, adjacent->matches);
    estimate(query.seed, *by_key);
    if (by_key->ok()) return by_key;
  }
  estimate(query.seed, *adjacent);
  return adjacent;
}

void PaperSearch::remember(const MotionStep& found) {
  chain_ = found.matches;
  chain_key_ = found.base->frame;
  chain_end_ = found.ok() ? current_->frame : -1;
  current_ = nullptr;
}

void PaperSearch::estimate(std::uint64_t seed, MotionStep& step) {
  const auto start = Clock::now();
  const StereoEdges now = refined_edges(step.matches);
  TemporalMatches numbered = step.matches;
  std::iota(numbered.current.begin(), numbered.current.end(), 0);
  pose::MeasuredEdges measured;
  const StereoRig rig = corrected_rig(rig_, step.rig);
  pose::measure_edges(rig, now, kMinEpipolarAngle, measured);
  quad_builder_.build(step.base->measured_edges(rig, kMinEpipolarAngle), now, measured, numbered, step.quads);
  step.quads.scoring.half_length = 0;
  step.motion = {};
  step.verdict.refusal = solve(seed, step);
  pose_ms_ += milliseconds_since(start);
}

Refusal PaperSearch::solve(std::uint64_t seed, MotionStep& step) {
  pose::MotionEstimate& motion = step.motion;
  motion.inlier.assign(step.quads.size(), 0);
  if (step.quads.size() < static_cast<std::size_t>(config_.min_inliers)) return Refusal::too_few_quads;
  const StereoRig rig = corrected_rig(rig_, step.rig);
  paper::PaperConsensus found = paper::find_paper_consensus(step.quads, rig.left, config_, seed);
  if (!found.current_from_previous) return Refusal::no_consensus;
  motion.inlier = std::move(found.inlier);
  motion.inliers = found.inliers;
  motion.current_from_previous = motion.learned.current_from_previous = *found.current_from_previous;
  const bool solved = !config_.refine || pose::refine(step.quads, rig, config_,
                                                      step.rig.disparity_offset_sigma * step.rig.disparity_offset_sigma,
                                                      refinement_, motion);
  if (!solved || !motion.learned.covariance.allFinite()) return Refusal::badly_spread;
  return motion.has_consensus(config_) ? Refusal::none : Refusal::no_consensus;
}

}  // namespace quadedge::odometry
