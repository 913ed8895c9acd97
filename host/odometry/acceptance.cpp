#include "odometry/acceptance.hpp"

#include <algorithm>

#include "frontend/prediction.hpp"
#include "odometry/odometry_constants.hpp"
#include "pose/scoring.hpp"

namespace quadedge::odometry {
namespace {

/// Edges of the base in one cell of the image.
struct Cell {
  double edges = 0, found = 0, explained = 0;
};

}  // namespace

void Acceptance::test_support(const EdgePositions& predicted, MotionStep& step) const {
  const int in_view = frontend::count_in_view(offset_.rig().left, predicted);
  step.verdict.support = step.motion.inliers / std::max(1.0, static_cast<double>(in_view));
  if (step.ok() && step.verdict.support < config_.temporal.min_support)
    step.motion.status = pose::MotionStatus::no_consensus;
}

void Acceptance::judge(const EdgePositions& predicted, MotionStep& step) const {
  step.verdict.static_ratio = static_ratio(step);
  pose::select_inliers(step.quads.scoring, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous),
                       kCloseAgreement * config_.pose.inlier_distance, config_.pose.inlier_orientation_rad(),
                       step.agrees);
  measure_area(predicted, step);
}

void Acceptance::measure_area(const EdgePositions& predicted, MotionStep& step) const {
  const PinholeCamera& camera = offset_.rig().left;
  const double side = config_.pose.scoring_cell > 0 ? config_.pose.scoring_cell : std::max(camera.width, camera.height);
  const int columns = static_cast<int>(camera.width / side) + 1, rows = static_cast<int>(camera.height / side) + 1;
  std::vector<Cell> cells(static_cast<std::size_t>(columns * rows));
  const auto cell_of = [&](std::size_t i) -> Cell* {
    const double x = static_cast<double>(predicted.x[i]) / side, y = static_cast<double>(predicted.y[i]) / side;
    if (!(x >= 0 && x < columns && y >= 0 && y < rows)) return nullptr;
    return &cells[static_cast<std::size_t>(static_cast<int>(y) * columns + static_cast<int>(x))];
  };
  for (std::size_t i = 0; i < predicted.x.size(); ++i)
    if (Cell* cell = cell_of(i)) cell->edges += 1;
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    const auto edge = step.matches.previous[static_cast<std::size_t>(step.quads.match[q])];
    Cell* cell = cell_of(static_cast<std::size_t>(edge));
    if (cell == nullptr) continue;
    cell->found += 1;
    cell->explained += step.agrees[q] != 0 ? 1 : 0;
  }
  double sum = 0, held = 0, in_view = 0, elsewhere = 0;
  for (const Cell& cell : cells) {
    if (!(cell.edges > 0)) continue;
    sum += cell.explained / cell.edges;
    held += 1;
    in_view += cell.edges;
    if (cell.explained < kMinExplainedRatio * std::max(cell.found, kMinFoundRatio * cell.edges))
      elsewhere += cell.edges;
  }
  step.verdict.explained_area = held > 0 ? sum / held : 0;
  step.verdict.moving_ratio = in_view > 0 ? elsewhere / in_view : 0;
}

double Acceptance::static_ratio(MotionStep& step) const {
  const double close = kCloseAgreement * config_.pose.inlier_distance, turn = config_.pose.inlier_orientation_rad();
  const auto& quads = step.quads.scoring;
  pose::select_inliers(quads, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous), 2 * close, turn,
                       step.agrees);
  pose::select_inliers(quads, pose::LaterCameras(offset_.rig(), Eigen::Isometry3d::Identity()), close, turn,
                       step.is_still);
  std::size_t still = 0;
  for (std::size_t q = 0; q < quads.size(); ++q) still += step.is_still[q] != 0 && step.agrees[q] == 0 ? 1 : 0;
  return static_cast<double>(still) / std::max(1.0, static_cast<double>(quads.size()));
}

bool Acceptance::are_same_motion(const MotionStep& found, const MotionStep& other,
                                 const Eigen::Isometry3d& base_from_other) const {
  std::vector<std::uint8_t> agrees;
  const Eigen::Isometry3d motion = other.motion.current_from_previous * base_from_other.inverse();
  pose::select_inliers(found.quads.scoring, pose::LaterCameras(offset_.rig(), motion), config_.pose.inlier_distance,
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
                                            const MotionStep& step) const {
  std::vector<std::uint8_t> agrees;
  Eigen::Isometry3d current_from_base = step.motion.current_from_previous;
  if (step.base != query.base) current_from_base = current_from_base * query.base_from_key.inverse();
  pose::select_inliers(global_matches.quads.scoring, pose::LaterCameras(offset_.rig(), current_from_base),
                       config_.temporal.wide_inlier_distance, config_.pose.inlier_orientation_rad(), agrees);
  return pose::count_cells(global_matches.quads.scoring, agrees, config_.pose.inflation_cell) >=
         config_.pose.min_inliers;
}

}  // namespace quadedge::odometry
