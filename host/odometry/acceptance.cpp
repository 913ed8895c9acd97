#include "odometry/acceptance.hpp"

#include <algorithm>

#include "odometry/prediction.hpp"
#include "pose/scoring.hpp"

namespace quadedge::odometry {
namespace {

/// A cell of the image shows something that moves otherwise where fewer of the edges that are found again are
/// explained, and counts as found that ratio of the edges in view at least.
constexpr double kHardlyExplained = 0.25, kFoundAtLeast = 0.1;

/// Ratio of edges in such cells from which on another motion is looked for. Rendered scenes have up to 0.02,
/// EuRoC 0.07, KITTI mostly 0.15 to 0.21; a motion that is not the world's leaves more of the image over than it
/// explains.
constexpr double kMuchLeftOver = 0.25;

/// Explained areas of two motions whose ratio is above this do not say which of them is the world's.
constexpr double kNearlyAsMuch = 0.4;

/// Where this ratio of the edges in view lies in cells that hardly follow it, a motion is a compromise or an accident.
constexpr double kMostLeftOver = 0.5;

/// Ratio of the quads that stand still against the motion. Sound recordings and scenes have up to 0.036 in single
/// frames, mostly below 0.001; a still camera whose motion is drawn from what moves before it 0.07 to 0.36.
constexpr double kStillAnyhow = 0.05;

/// Two motions that share more of the inliers are one.
constexpr double kTheSameMotion = 0.7;

/// Support that a wrong motion may find by chance, in fine texture.
constexpr double kChanceSupport = 0.2;

/// Of the support that motions have had lately: a motion with as much of it is one of theirs.
constexpr double kUsualSupport = 0.5;

/// What is left per frame of the support that was reached.
constexpr double kForgetting = 0.95;

}  // namespace

void Acceptance::test_support(const EdgePositions& predicted, MotionStep& step) const {
  const int in_view = count_in_view(offset_.rig().left, predicted);
  step.support = step.motion.inliers / std::max(1.0, static_cast<double>(in_view));
  if (step.ok() && step.support < config_.temporal.min_support) step.motion.status = pose::MotionStatus::no_consensus;
}

void Acceptance::measure_area(const EdgePositions& predicted, MotionStep& step) {
  const PinholeCamera& camera = offset_.rig().left;
  const double side = config_.pose.scoring_cell > 0 ? config_.pose.scoring_cell : std::max(camera.width, camera.height);
  const int columns = static_cast<int>(camera.width / side) + 1, rows = static_cast<int>(camera.height / side) + 1;
  cells_.assign(static_cast<std::size_t>(columns * rows), {});
  const auto cell_of = [&](std::size_t i) -> Cell* {
    const double x = static_cast<double>(predicted.x[i]) / side, y = static_cast<double>(predicted.y[i]) / side;
    if (!(x >= 0 && x < columns && y >= 0 && y < rows)) return nullptr;
    return &cells_[static_cast<std::size_t>(static_cast<int>(y) * columns + static_cast<int>(x))];
  };
  for (std::size_t i = 0; i < predicted.x.size(); ++i)
    if (Cell* cell = cell_of(i)) cell->edges += 1;
  pose::select_inliers(step.quads.scoring, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous),
                       kCloseAgreement * config_.pose.inlier_distance, config_.pose.inlier_orientation_rad(), agrees_);
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    const auto edge = step.matches.previous[static_cast<std::size_t>(step.quads.match[q])];
    Cell* cell = cell_of(static_cast<std::size_t>(edge));
    if (cell == nullptr) continue;
    cell->found += 1;
    cell->explained += agrees_[q] != 0 ? 1 : 0;
  }
  double sum = 0, held = 0, in_view = 0, elsewhere = 0;
  for (const Cell& cell : cells_) {
    if (!(cell.edges > 0)) continue;
    sum += cell.explained / cell.edges;
    held += 1;
    in_view += cell.edges;
    if (cell.explained < kHardlyExplained * std::max(cell.found, kFoundAtLeast * cell.edges)) elsewhere += cell.edges;
  }
  step.explained_area = held > 0 ? sum / held : 0;
  step.moving_ratio = in_view > 0 ? elsewhere / in_view : 0;
}

bool Acceptance::contradicts_static_scene(const MotionStep& step) {
  if (!step.ok()) return false;
  const double close = kCloseAgreement * config_.pose.inlier_distance, turn = config_.pose.inlier_orientation_rad();
  const auto& quads = step.quads.scoring;
  pose::select_inliers(quads, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous), 2 * close, turn,
                       agrees_);
  pose::select_inliers(quads, pose::LaterCameras(offset_.rig(), Eigen::Isometry3d::Identity()), close, turn, is_still_);
  std::size_t still = 0;
  for (std::size_t q = 0; q < quads.size(); ++q) still += is_still_[q] != 0 && agrees_[q] == 0 ? 1 : 0;
  return static_cast<double>(still) > kStillAnyhow * static_cast<double>(quads.size());
}

double Acceptance::confident_support() const {
  return std::min(config_.temporal.confident_support, std::max(kChanceSupport, kUsualSupport * reached_support_));
}

void Acceptance::remember(const MotionStep& found) {
  reached_support_ = found.ok() ? std::max(found.support, kForgetting * reached_support_) : kUnknownSupport;
}

bool Acceptance::is_confident(const MotionStep& step) const {
  const bool can_ask_further = config_.temporal.wide_edges > 0;
  return step.ok() && (!can_ask_further || step.support >= confident_support());
}

bool Acceptance::has_secondary_motion(const MotionStep& step) { return step.moving_ratio > kMuchLeftOver; }

bool Acceptance::is_minority_motion(const MotionStep& step) { return step.moving_ratio > kMostLeftOver; }

bool Acceptance::are_competing(const MotionStep& found, const MotionStep& other,
                               const Eigen::Isometry3d& base_from_other) {
  if (!found.ok() || !other.ok() || other.explained_area < kNearlyAsMuch * found.explained_area) return false;
  return !are_same_motion(found, other, base_from_other);
}

bool Acceptance::are_same_motion(const MotionStep& found, const MotionStep& other,
                                 const Eigen::Isometry3d& base_from_other) {
  const Eigen::Isometry3d motion = other.motion.current_from_previous * base_from_other.inverse();
  pose::select_inliers(found.quads.scoring, pose::LaterCameras(offset_.rig(), motion), config_.pose.inlier_distance,
                       config_.pose.inlier_orientation_rad(), agrees_);
  int inliers = 0, shared = 0;
  for (std::size_t q = 0; q < agrees_.size(); ++q) {
    if (found.motion.inlier[q] == 0) continue;
    ++inliers;
    shared += agrees_[q];
  }
  return shared >= kTheSameMotion * inliers;
}

bool Acceptance::agrees_with_global_matches(const MotionStep& global_matches, const MotionQuery& query,
                                            const MotionStep& step) {
  Eigen::Isometry3d current_from_base = step.motion.current_from_previous;
  if (step.base != query.base) current_from_base = current_from_base * query.base_from_key.inverse();
  pose::select_inliers(global_matches.quads.scoring, pose::LaterCameras(offset_.rig(), current_from_base),
                       config_.temporal.wide_inlier_distance, config_.pose.inlier_orientation_rad(), agrees_);
  return pose::count_cells(global_matches.quads.scoring, agrees_, config_.pose.inflation_cell) >=
         config_.pose.min_inliers;
}

}  // namespace quadedge::odometry
