#include "motion/acceptance.hpp"

#include <algorithm>

#include "frontend/prediction.hpp"
#include "motion/motion_constants.hpp"
#include "pose/scoring.hpp"
#include "quadedge/pi.hpp"

namespace quadedge::motion {

void Acceptance::test_support(const EdgePositions& predicted, MotionStep& step) const {
  const int in_view = frontend::count_in_view(offset_.rig().left, predicted);
  step.verdict.support = step.motion.inliers / std::max(1.0, static_cast<double>(in_view));
  if (step.ok() && step.verdict.support < config_.temporal.min_support)
    step.motion.status = pose::MotionStatus::no_consensus;
}

void Acceptance::judge(const EdgePositions& predicted, MotionStep& step) const {
  step.verdict.static_ratio = static_ratio(step, step.masks);
  pose::select_inliers(step.quads.scoring, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous),
                       kCloseAgreement * config_.pose.inlier_distance, config_.pose.inlier_orientation_rad(),
                       step.agrees);
  measure_area(predicted, step);
}

void Acceptance::measure_area(const EdgePositions& predicted, MotionStep& step) const {
  step.cells.start(offset_.rig().left, config_.pose.scoring_cell);
  for (std::size_t i = 0; i < predicted.x.size(); ++i)
    if (ExplainedCell* cell = step.cells.at(predicted.x[i], predicted.y[i])) cell->edges += 1;
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    const auto edge = static_cast<std::size_t>(step.matches.previous[static_cast<std::size_t>(step.quads.match[q])]);
    ExplainedCell* cell = step.cells.at(predicted.x[edge], predicted.y[edge]);
    if (cell == nullptr) continue;
    cell->found += 1;
    cell->explained += step.agrees[q] != 0 ? 1 : 0;
  }
  step.verdict.explained_area = step.cells.explained_area();
  step.verdict.moving_ratio = step.cells.moving_ratio();
}

ExplainedCells Acceptance::explained_beside(const MotionStep& other, const Eigen::Isometry3d& chosen,
                                            double distance) const {
  std::vector<std::uint8_t> shared;
  pose::select_inliers(other.quads.scoring, pose::LaterCameras(offset_.rig(), chosen), distance, 0.5 * kPi, shared);
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

double Acceptance::static_ratio(const MotionStep& step, InlierMasks& masks) const {
  const double close = kCloseAgreement * config_.pose.inlier_distance, turn = config_.pose.inlier_orientation_rad();
  const auto& quads = step.quads.scoring;
  pose::select_inliers(quads, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous), 2 * close, turn,
                       masks.follows);
  pose::select_inliers(quads, pose::LaterCameras(offset_.rig(), Eigen::Isometry3d::Identity()), close, turn,
                       masks.is_still);
  std::size_t still = 0;
  for (std::size_t q = 0; q < quads.size(); ++q) still += masks.is_still[q] != 0 && masks.follows[q] == 0 ? 1 : 0;
  return static_cast<double>(still) / std::max(1.0, static_cast<double>(quads.size()));
}

double Acceptance::area_beside(const MotionStep& found, const MotionStep& other,
                               const Eigen::Isometry3d& motion) const {
  ExplainedCells cells = explained_beside(found, motion, kCloseAgreement * config_.pose.inlier_distance);
  for (std::size_t i = 0; i < cells.all().size(); ++i)
    if (!other.cells.all()[i].is_free()) cells.all()[i].explained = 0;
  return cells.explained_area();
}

bool Acceptance::is_same_motion(const MotionStep& found, const Eigen::Isometry3d& other) const {
  std::vector<std::uint8_t> agrees;
  pose::select_inliers(found.quads.scoring, pose::LaterCameras(offset_.rig(), other), config_.pose.inlier_distance,
                       config_.pose.inlier_orientation_rad(), agrees);
  int inliers = 0, shared = 0;
  for (std::size_t q = 0; q < agrees.size(); ++q) {
    if (found.motion.inlier[q] == 0) continue;
    ++inliers;
    shared += agrees[q];
  }
  return shared >= kSharedInlierRatio * inliers;
}

bool Acceptance::agrees_with_global_matches(const MotionStep& global_matches, const MotionQuery& query,
                                            const MotionStep& step, double& ratio) const {
  std::vector<std::uint8_t> agrees;
  const int agreeing = pose::select_inliers(
      global_matches.quads.scoring, pose::LaterCameras(offset_.rig(), motion_since(query.base, query, step)),
      config_.temporal.wide_inlier_distance, config_.pose.inlier_orientation_rad(), agrees);
  ratio = agreeing / std::max(1.0, static_cast<double>(agrees.size()));
  return pose::count_cells(global_matches.quads.scoring, agrees, config_.pose.inflation_cell) >=
         config_.pose.min_inliers;
}

}  // namespace quadedge::motion
