/// \file motion_step.cpp  Per cell, edges, matches and inliers; areas, spreads and ratios are sums over the cells.
#include "motion/motion_step.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "motion/odometry_constants.hpp"

namespace quadedge::odometry {

bool ExplainedCell::follows() const {
  return explained >= kMinExplainedRatio * std::max(found, kMinFoundRatio * edges);
}

void ExplainedCells::start(const PinholeCamera& camera, double side) {
  side_ = side > 0 ? side : std::max(camera.width, camera.height);
  columns_ = static_cast<int>(camera.width / side_) + 1;
  rows_ = static_cast<int>(camera.height / side_) + 1;
  cells_.assign(static_cast<std::size_t>(columns_ * rows_), {});
}

ExplainedCell* ExplainedCells::at(float x, float y) {
  const double column = static_cast<double>(x) / side_, row = static_cast<double>(y) / side_;
  if (!(column >= 0 && column < columns_ && row >= 0 && row < rows_) || cells_.empty()) return nullptr;
  return &cells_[static_cast<std::size_t>(static_cast<int>(row) * columns_ + static_cast<int>(column))];
}

int ExplainedCells::count(bool following) const {
  return static_cast<int>(std::count_if(cells_.begin(), cells_.end(), [&](const ExplainedCell& cell) {
    return cell.edges > 0 && cell.follows() == following;
  }));
}

double ExplainedCells::explained_area() const {
  double sum = 0;
  for (const ExplainedCell& cell : cells_) sum += cell.edges > 0 ? cell.explained / cell.edges : 0;
  return sum / std::max(1, count(true) + count(false));
}

Eigen::Array2d ExplainedCells::spreads(std::optional<bool> following) const {
  double count = 0;
  Eigen::Array2d sum = Eigen::Array2d::Zero(), squares = Eigen::Array2d::Zero();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!(cells_[i].edges > 0) || cells_[i].follows() != following.value_or(cells_[i].follows())) continue;
    const Eigen::Array2d position(static_cast<int>(i) % columns_, static_cast<int>(i) / columns_);
    count += 1;
    sum += position;
    squares += position.square();
  }
  if (!(count > 0)) return Eigen::Array2d::Zero();
  return (squares / count - (sum / count).square()).max(0).sqrt();
}

double ExplainedCells::moving_ratio() const {
  double in_view = 0, moving = 0;
  for (const ExplainedCell& cell : cells_) {
    in_view += cell.edges;
    moving += cell.follows() ? 0 : cell.edges;
  }
  return in_view > 0 ? moving / in_view : 0;
}

double MotionStep::mean_inverse_depth() const {
  double sum = 0;
  for (std::size_t q = 0; q < motion.inlier.size(); ++q)
    if (motion.inlier[q] != 0) sum += static_cast<double>(quads.scoring.inverse_depth[q]);
  return motion.inliers > 0 ? sum / motion.inliers : 0;
}

void MotionStep::clear() {
  base = nullptr;
  matches.clear();
  motion.inliers = 0;
  motion.inlier.clear();
  agrees.clear();
  cells.clear();
  verdict = {};
  is_checked = shows_other_part = false;
}

Eigen::Isometry3d motion_since(const frontend::FrameEdgesHandle& frame_edges, const MotionQuery& query,
                               const MotionStep& step) {
  if (step.base == frame_edges) return step.motion.current_from_previous;
  return step.motion.current_from_previous *
         (frame_edges == query.base ? query.base_from_key.inverse() : query.base_from_key);
}

}  // namespace quadedge::odometry
