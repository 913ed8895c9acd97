#include "odometry/acceptance.hpp"

#include <algorithm>

#include "odometry/prediction.hpp"
#include "pose/scoring.hpp"

namespace quadedge::odometry {
namespace {

/// In an image cell that shows another motion, less than this fraction of the edges found again is explained by the
/// motion. A cell counts as having found at least kMinFoundRatio of its edges in view.
constexpr double kMinExplainedRatio = 0.25, kMinFoundRatio = 0.1;

/// Fraction of the edges in view that lie in such cells, above which another motion is searched for. Rendered scenes
/// reach 0.02, EuRoC 0.07, KITTI mostly 0.15 to 0.21; a motion that is not the camera's fails to explain more of the
/// image than it explains.
constexpr double kSecondaryMotionRatio = 0.25;

/// Two motions whose explained areas have a ratio above this are ambiguous.
constexpr double kCompetingAreaRatio = 0.4;

/// A motion with more than this fraction of the edges in view in such cells is a compromise between motions or
/// accidental.
constexpr double kMinorityMotionRatio = 0.5;

/// Fraction of the quads that are static although the motion would have moved them. Valid motions reach 0.036 in single
/// frames and are mostly below 0.001; a stationary camera whose motion was estimated from objects moving in front of it
/// has 0.07 to 0.36.
constexpr double kStaticQuadRatio = 0.05;

/// Two motions that share more than this fraction of the inliers are the same motion.
constexpr double kSharedInlierRatio = 0.7;

/// Support that a wrong motion may reach by chance in fine texture.
constexpr double kChanceSupport = 0.2;

/// A motion is confident if it reaches this fraction of the support that recent motions had.
constexpr double kRecentSupportRatio = 0.5;

/// Decay of the recent support per frame.
constexpr double kSupportDecay = 0.95;

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
    if (cell.explained < kMinExplainedRatio * std::max(cell.found, kMinFoundRatio * cell.edges))
      elsewhere += cell.edges;
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
  return static_cast<double>(still) > kStaticQuadRatio * static_cast<double>(quads.size());
}

double Acceptance::confident_support() const {
  return std::min(config_.temporal.confident_support, std::max(kChanceSupport, kRecentSupportRatio * recent_support_));
}

void Acceptance::remember(const MotionStep& found) {
  recent_support_ = found.ok() ? std::max(found.support, kSupportDecay * recent_support_) : kUnknownSupport;
}

bool Acceptance::is_confident(const MotionStep& step) const {
  const bool can_ask_further = config_.temporal.wide_edges > 0;
  return step.ok() && (!can_ask_further || step.support >= confident_support());
}

bool Acceptance::has_secondary_motion(const MotionStep& step) { return step.moving_ratio > kSecondaryMotionRatio; }

bool Acceptance::is_minority_motion(const MotionStep& step) { return step.moving_ratio > kMinorityMotionRatio; }

bool Acceptance::are_competing(const MotionStep& found, const MotionStep& other,
                               const Eigen::Isometry3d& base_from_other) {
  if (!found.ok() || !other.ok() || other.explained_area < kCompetingAreaRatio * found.explained_area) return false;
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
  return shared >= kSharedInlierRatio * inliers;
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
