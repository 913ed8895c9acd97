/// \file motion_proposals.cpp  Fits a motion to matches within a radius, to global ones, or to those left over.
#include "motion/motion_proposals.hpp"

#include <algorithm>
#include <cmath>

#include "common/matching_constants.hpp"
#include "common/timing.hpp"
#include "edges/prediction.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/pose_constants.hpp"
#include "motion/scoring.hpp"

namespace quadedge::odometry {
namespace {

/// The inlier distance is larger because a global match may be a neighbour of the correct edge.
PoseConfig limits_of_global_matches(const Config& config) {
  PoseConfig limits = limits_of_proposals(config);
  limits.inlier_distance = kGlobalInlierDistance;
  return limits;
}

/// Collects the indices of the positions that lie in free cells; if there are more than `wanted`, only every n-th, so
/// that at most `wanted` and more than half of that remain.
void collect_free(const ExplainedCells& cells, const std::vector<float>& x, const std::vector<float>& y, int wanted,
                  std::vector<std::int32_t>& numbers) {
  numbers.clear();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const ExplainedCell* cell = cells.at(x[i], y[i]);
    if (cell != nullptr && cell->is_free()) numbers.push_back(static_cast<std::int32_t>(i));
  }
  const auto most = static_cast<std::size_t>(wanted);
  const std::size_t step = std::max<std::size_t>(1, (numbers.size() + most - 1) / most);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < numbers.size(); k += step) numbers[kept++] = numbers[k];
  numbers.resize(kept);
}

}  // namespace

StepHandle MotionFits::new_step(const MotionQuery& query, const frontend::FrameEdgesHandle& base) {
  StepHandle step = steps_.acquire();
  step->base = base;
  step->rig = query.rig;
  return step;
}

void MotionFits::fit(const MotionQuery& query, const PoseConfig& limits,
                     const std::optional<Eigen::Isometry3d>& initial, pose::RefinementGoal goal, MotionStep& step) {
  const auto start = Clock::now();
  const auto lend_measurements = [&] {
    step.quads.previous.swap(previous_);
    step.quads.current.swap(current_);
  };
  lend_measurements();
  quad_builder_.build(measured(*step.base, query), query.current->edges, measured(*query.current, query), step.matches,
                      step.quads);
  step.quads.scoring.half_length =
      pose::QuadBuilder::half_length(std::max(step.base->edges_spacing, query.current->edges_spacing));
  step.verdict = {};
  // A displacement that is not known exactly is that of both frames, as one is measured against the other.
  const double offset = query.rig.disparity_offset_sigma, displacement = step.base->rig().displacement_sigma;
  const double sigma = offset > 0 ? std::hypot(offset, displacement) : 0;
  const pose::OffsetPrior prior(sigma * sigma, query.rig.disparity_offset_shared, query.rig.disparity_error);
  step.verdict.refusal =
      estimator_.estimate(calibration(query), step.quads, limits, query.seed, initial, prior, step.motion, goal);
  lend_measurements();
  pose_ms_ += milliseconds_since(start);
}

const pose::MeasuredEdges& MotionFits::measured(const frontend::FrameEdges& frame_edges,
                                                const MotionQuery& query) const {
  const bool is_current = &frame_edges == query.current.get();
  const RigEstimate rig = is_current ? query.rig : query.rig.of(frame_edges.rig());
  return frame_edges.measured_edges(corrected_rig(rig_, rig), kMinEpipolarAngle);
}

PoseConfig limits_of_proposals(const Config& config) {
  PoseConfig limits = config.pose;
  limits.min_inlier_ratio = kProposalMinInlierRatio;
  limits.min_spread = 0;
  return limits;
}

MotionProposals::MotionProposals(const Config& config, frontend::GlobalFrontend& frontend, MotionFits& fits)
    : config_(config),
      limits_(limits_of_proposals(config)),
      global_limits_(limits_of_global_matches(config)),
      frontend_(frontend),
      fits_(fits) {}

StepHandle MotionProposals::near_prediction(const MotionQuery& query) {
  return query.prediction ? in_radius(query, config_.temporal.coarse_radius) : nullptr;
}

StepHandle MotionProposals::in_large_radius(const MotionQuery& query) {
  return in_radius(query, kLargeRadiusRatio * fits_.calibration(query).left.width);
}

StepHandle MotionProposals::in_radius(const MotionQuery& query, double radius) {
  const StereoEdges& edges = query.base->edges;
  const int wanted = config_.temporal.coarse_edges;
  const int every = std::max(1, (static_cast<int>(edges.size()) + wanted - 1) / wanted);
  frontend::predict_positions(fits_.calibration(query), edges, fits_.measured(*query.base, query), query.prediction,
                              radius, every, search_);
  search_.coarse = true;
  StepHandle step = fits_.new_step(query, query.base);
  frontend_.match(*query.base, *query.current, search_, step->matches);
  fits_.fit(query, limits_, query.prediction, pose::RefinementGoal::pose, *step);
  return step;
}

StepHandle MotionProposals::still_camera(const MotionQuery& query) {
  StepHandle step = fits_.new_step(query, query.base);
  step->motion = {};
  step->verdict.refusal = Refusal::none;
  return step;
}

StepHandle MotionProposals::few_global_matches(const MotionQuery& query) {
  StepHandle step = matched_globally(query, config_.temporal.global_edges / kFewMatchesThinning);
  if (!step->ok() || step->motion.inlier_ratio() < kFewMatchesRatio) return nullptr;
  const int cells = pose::count_cells(step->quads.scoring, step->motion.inlier, pose::kInflationCell);
  return cells >= kFewMatchesCells * config_.pose.min_inliers ? std::move(step) : nullptr;
}

StepHandle MotionProposals::global_matches(const MotionQuery& query) {
  StepHandle few = query.at_start ? nullptr : few_global_matches(query);  // at the start they have left a doubt
  return few ? std::move(few) : matched_globally(query, config_.temporal.global_edges);
}

StepHandle MotionProposals::matched_globally(const MotionQuery& query, int edges) {
  StepHandle step = fits_.new_step(query, query.base);
  frontend_.match_globally(*query.base, *query.current, edges, step->matches);
  fits_.fit(query, global_limits_, std::nullopt, pose::RefinementGoal::pose, *step);
  return step;
}

StepHandle MotionProposals::rest_of_global_matches(const MotionQuery& query, const MotionStep& global_matches) {
  if (!global_matches.ok()) return nullptr;
  is_rest_.assign(global_matches.matches.size(), 1);
  for (std::size_t q = 0; q < global_matches.quads.size(); ++q)
    if (global_matches.motion.inlier[q] != 0) is_rest_[static_cast<std::size_t>(global_matches.quads.match[q])] = 0;
  PoseConfig limits = global_limits_;
  limits.min_inliers = std::max(limits.min_inliers, static_cast<int>(kRestRatio * global_matches.motion.inliers));
  return with_rest_of(query, global_matches, limits);
}

StepHandle MotionProposals::rest_of_confirmed(const MotionQuery& query, const MotionStep& confirmed) {
  is_rest_.assign(confirmed.matches.size(), 0);
  for (std::size_t q = 0; q < confirmed.quads.size(); ++q)
    if (confirmed.agrees[q] == 0) is_rest_[static_cast<std::size_t>(confirmed.quads.match[q])] = 1;
  PoseConfig limits = limits_;
  limits.inlier_distance *= kCloseAgreement;
  StepHandle step = with_rest_of(query, confirmed, limits);
  step->motion.current_from_previous = motion_since(query.base, query, *step);
  step->base = query.base;
  return step;
}

StepHandle MotionProposals::with_rest_of(const MotionQuery& query, const MotionStep& other, const PoseConfig& limits) {
  StepHandle step = fits_.new_step(query, other.base);
  for (std::size_t m = 0; m < other.matches.size(); ++m) {
    if (is_rest_[m] == 0) continue;
    step->matches.append(other.matches.previous[m], other.matches.current[m], query.current->edges,
                         other.matches.ncc[m], other.matches.competing_clusters[m]);
  }
  fits_.fit(query, limits, std::nullopt, pose::RefinementGoal::pose, *step);
  return step;
}

StepHandle MotionProposals::in_free_cells(const MotionQuery& query, const MotionStep& chosen) {
  frontend::predict_positions(fits_.calibration(query), query.base->edges, fits_.measured(*query.base, query),
                              motion_since(query.base, query, chosen), config_.temporal.radius, 1, search_);
  const StereoEdges& current = query.current->edges;
  const int wanted = std::max(1, config_.temporal.global_edges / kFreeCellThinning);
  collect_free(chosen.cells, search_.left.x, search_.left.y, wanted, among_.of_base);
  collect_free(chosen.cells, current.left_x, current.left_y, 2 * wanted, among_.of_current);
  StepHandle step = fits_.new_step(query, query.base);
  frontend_.match_globally(*query.base, *query.current, among_, step->matches);
  fits_.fit(query, global_limits_, std::nullopt, pose::RefinementGoal::pose, *step);
  return step;
}

}  // namespace quadedge::odometry
