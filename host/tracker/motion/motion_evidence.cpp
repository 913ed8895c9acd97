/// \file motion_evidence.cpp  Counts what agrees with one motion, with standstill and with rivals, per image cell.
#include "motion/motion_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "edges/prediction.hpp"
#include "motion/moving_cells.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/pose_constants.hpp"
#include "motion/scoring.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::odometry {

void MotionEvidence::judge(const EdgePositions& predicted, double min_support, MotionStep& step) {
  const int in_view = frontend::count_in_view(rig_.left, predicted);
  step.verdict.support = step.motion.inliers / std::max(1.0, static_cast<double>(in_view));
  if (step.verdict.support < min_support) step.verdict.refuse(Refusal::little_support);
  if (!step.ok()) return;
  compare_with_standstill(step);
  select(step, step.motion.current_from_previous, kCloseAgreement * config_.pose.inlier_distance,
         pose::kInlierOrientation, step.agrees);
  measure_area(predicted, step);
}

int MotionEvidence::select(const MotionStep& step, const Eigen::Isometry3d& motion, double distance, double angle,
                           std::vector<std::uint8_t>& inlier) const {
  return pose::select_inliers(step.quads.scoring, pose::LaterCameras(corrected_rig(rig_, step.rig), motion), distance,
                              angle, inlier);
}

/// Sets the area, which weights objects by the area that they cover, not by their number of edges, and the moving
/// ratio.
void MotionEvidence::measure_area(const EdgePositions& predicted, MotionStep& step) const {
  step.cells.start(rig_.left, config_.pose.scoring_cell);
  for (std::size_t i = 0; i < predicted.x.size(); ++i)
    if (ExplainedCell* cell = step.cells.at(predicted.x[i], predicted.y[i])) cell->edges += 1;
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    const auto edge = static_cast<std::size_t>(step.matches.previous[static_cast<std::size_t>(step.quads.match[q])]);
    ExplainedCell* cell = step.cells.at(predicted.x[edge], predicted.y[edge]);
    if (cell == nullptr) continue;
    cell->found += 1;
    cell->explained += step.agrees[q] != 0 ? 1 : 0;
  }
  step.verdict.area = step.cells.explained_area();
  step.verdict.moving_ratio = step.cells.moving_ratio();
  step.verdict.inliers = step.motion.inliers;
  step.verdict.followed = step.cells.count(true);
  const MovingCells moving = find_moving_cells(step.cells);
  step.verdict.moving_cells = moving.count;
  if (moving.count > 0)
    step.verdict.moving_box.emplace() << moving.largest.min().x(), moving.largest.min().y(), moving.largest.max().x(),
        moving.largest.max().y();
  const double all = step.verdict.followed + step.cells.count(false);
  if (moving.spread > kSurroundingSpread * step.cells.spread()) step.verdict.around_ratio = moving.count / all;
}

/// Sets the ratios of quads that are static. Edges are not static by chance, and distant edges agree with the motion as
/// well. Hence, either the camera did not move, or something moves along with it.
void MotionEvidence::compare_with_standstill(MotionStep& step) {
  const double close = kCloseAgreement * config_.pose.inlier_distance, turn = pose::kInlierOrientation;
  select(step, step.motion.current_from_previous, 2 * close, turn, follows_);
  select(step, Eigen::Isometry3d::Identity(), close, turn, is_still_);
  double still = 0, following = 0;
  for (std::size_t q = 0; q < step.quads.size(); ++q)
    if (is_still_[q] != 0) (follows_[q] != 0 ? following : still) += 1;
  const double quads = std::max(1.0, static_cast<double>(step.quads.size()));
  step.verdict.static_ratio = std::max(still, still_near_edges(step)) / quads;
  step.verdict.still_ratio = following / quads;
}

/// Number of edges, nearer than those that the motion explains are on average, that standstill explains and the motion
/// does not, half as far off as close agreement allows; 0 unless the opposite is far less frequent. A turn about what
/// is near and fixed moves what is far as a step does, so that one motion fits both, worse than each of two.
double MotionEvidence::still_near_edges(const MotionStep& step) {
  const double half = 0.5 * kCloseAgreement * config_.pose.inlier_distance, turn = pose::kInlierOrientation;
  const double mean = step.mean_inverse_depth();
  select(step, step.motion.current_from_previous, half, turn, follows_);
  select(step, Eigen::Isometry3d::Identity(), half, turn, is_still_);
  double still = 0, following = 0;
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    if (is_still_[q] == follows_[q] || static_cast<double>(step.quads.scoring.inverse_depth[q]) <= mean) continue;
    (follows_[q] != 0 ? following : still) += 1;
  }
  return still > kStillNearEdges * following ? still : 0;
}

double MotionEvidence::still_beside(const MotionStep& still, const Eigen::Isometry3d& motion) {
  const double close = kCloseAgreement * config_.pose.inlier_distance, turn = pose::kInlierOrientation;
  const pose::ScoringArrays& quads = still.quads.scoring;
  std::vector<std::uint8_t> is_exact;
  select(still, motion, 2 * close, turn, follows_);
  select(still, Eigen::Isometry3d::Identity(), close, turn, is_still_);
  select(still, Eigen::Isometry3d::Identity(), kCloseAgreement * close, turn, is_exact);
  double alone = 0, exact = 0;
  Eigen::Array2d sum = Eigen::Array2d::Zero(), squares = Eigen::Array2d::Zero();
  for (std::size_t q = 0; q < is_still_.size(); ++q) {
    if (is_still_[q] == 0 || follows_[q] != 0) continue;
    alone += 1;
    if (is_exact[q] == 0) continue;
    exact += 1;
    const Eigen::Array2d place(quads.left_x[q] / rig_.left.width, quads.left_y[q] / rig_.left.height);
    sum += place;
    squares += place.square();
  }
  if (exact < config_.pose.min_inliers || exact < kExactStill * alone) return 0;
  const double spread = std::sqrt((squares / exact - (sum / exact).square()).sum()), whole = std::sqrt(2.0 / 12);
  return spread > kSurroundingSpread * whole ? exact / static_cast<double>(is_still_.size()) : 0;
}

ExplainedCells MotionEvidence::explained_beside(const MotionStep& other, const Eigen::Isometry3d& chosen,
                                                double distance) const {
  std::vector<std::uint8_t> shared;
  select(other, chosen, distance, 0.5 * kPi, shared);
  ExplainedCells cells = other.cells;
  for (ExplainedCell& cell : cells.all()) cell.explained = 0;
  for (std::size_t q = 0; q < shared.size(); ++q) {
    ExplainedCell* cell = cells.at(other.quads.scoring.left_x[q], other.quads.scoring.left_y[q]);
    if (cell != nullptr && other.agrees[q] != 0 && shared[q] == 0) cell->explained += 1;
  }
  for (ExplainedCell& cell : cells.all())
    if (cell.explained < kMinCellEdges) cell.explained = 0;
  return cells;
}

double MotionEvidence::area_beside(const MotionStep& found, const MotionStep& other,
                                   const Eigen::Isometry3d& motion) const {
  ExplainedCells cells = explained_beside(found, motion, kCloseAgreement * config_.pose.inlier_distance);
  for (std::size_t i = 0; i < cells.all().size(); ++i)
    if (!other.cells.all()[i].is_free()) cells.all()[i].explained = 0;
  return cells.explained_area();
}

bool MotionEvidence::is_same_motion(const MotionStep& found, const Eigen::Isometry3d& other) const {
  std::vector<std::uint8_t> agrees;
  select(found, other, config_.pose.inlier_distance, pose::kInlierOrientation, agrees);
  int inliers = 0, shared = 0;
  for (std::size_t q = 0; q < agrees.size(); ++q) {
    if (found.motion.inlier[q] == 0) continue;
    ++inliers;
    shared += agrees[q];
  }
  return shared >= kSharedInlierRatio * inliers;
}

void MotionEvidence::compare_globally(const MotionStep& global_matches, const MotionStep* rest,
                                      const Eigen::Isometry3d& motion, Verdict& verdict) const {
  std::vector<std::uint8_t> agrees, of_rest;
  const int agreeing = select(global_matches, motion, kGlobalInlierDistance, pose::kInlierOrientation, agrees);
  if (rest != nullptr) select(*rest, motion, kGlobalInlierDistance, pose::kInlierOrientation, of_rest);
  const auto follow_instead = [](const std::vector<std::uint8_t>& proposed, const std::vector<std::uint8_t>& these) {
    int count = 0;
    for (std::size_t q = 0; q < these.size(); ++q) count += proposed[q] != 0 && these[q] == 0 ? 1 : 0;
    return count;
  };
  const int rival = std::max(follow_instead(global_matches.motion.inlier, agrees),
                             rest == nullptr ? 0 : follow_instead(rest->motion.inlier, of_rest));
  verdict.rival_ratio = rival / std::max(1.0, static_cast<double>(agreeing));
  verdict.global_ratio = agreeing / std::max(1.0, static_cast<double>(agrees.size()));
  verdict.agrees_globally =
      pose::count_cells(global_matches.quads.scoring, agrees, pose::kInflationCell) >= config_.pose.min_inliers;
}

void MotionEvidence::compare_globally(const MotionStep& global_matches, const Eigen::Isometry3d& other,
                                      const MotionStep& chosen, const Eigen::Isometry3d& by_chosen,
                                      OtherPart& part) const {
  std::vector<std::uint8_t> alone, others;
  select(global_matches, other, kGlobalInlierDistance, pose::kInlierOrientation, alone);
  const int of_chosen = select(global_matches, by_chosen, kGlobalInlierDistance, 0.5 * kPi, others);
  const pose::ScoringArrays& quads = global_matches.quads.scoring;
  ExplainedCells cells = chosen.cells;
  for (ExplainedCell& cell : cells.all()) cell = {};
  double count = 0;
  for (std::size_t q = 0; q < alone.size(); ++q) {
    if (others[q] != 0) alone[q] = 0;
    if (alone[q] == 0) continue;
    count += 1;
    if (ExplainedCell* cell = cells.at(quads.left_x[q], quads.left_y[q])) cell->edges = cell->explained = 1;
  }
  part.balance = count / std::max(1, of_chosen);
  part.match_spread = (cells.spreads() / chosen.cells.spreads().max(1e-9)).minCoeff();
  part.agrees_globally = pose::count_cells(quads, alone, pose::kInflationCell) >= config_.pose.min_inliers;
}

}  // namespace quadedge::odometry
