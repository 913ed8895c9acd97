#include "odometry/image_jump.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"
#include "odometry/odometry_constants.hpp"

namespace quadedge::odometry {

bool ImageJump::is_certain(double least) const {
  const double size = std::abs(shift);
  return size >= least && size >= kJumpSigmas * sigma && kJumpScatter * size >= scatter;
}

double JumpMeter::median_distance(const Eigen::Vector4d& values) {
  scratch_.clear();
  for (const Row& row : rows_) scratch_.push_back(std::abs(row.difference - row.terms.dot(values)));
  return upper_median(scratch_);
}

std::optional<ImageJump> JumpMeter::measure(const pose::MeasuredEdges& before, const pose::MeasuredEdges& now,
                                            const TemporalMatches& matches, const Eigen::Isometry3d& now_from_before) {
  rows_.clear();
  scratch_.clear();
  for (std::size_t m = 0; m < matches.size(); ++m) {
    const auto& from = before[static_cast<std::size_t>(matches.previous[m])];
    const auto& to = now[static_cast<std::size_t>(matches.current[m])];
    if (!from || !to || !(to->inverse_depth_per_pixel > 0)) continue;
    const Eigen::Vector3d at =
        now_from_before.linear() * from->ray + now_from_before.translation() * from->inverse_depth;
    if (!(at.z() > 0)) continue;
    const double predicted = from->inverse_depth / at.z(), pixels = predicted / to->inverse_depth_per_pixel;
    rows_.push_back({(to->inverse_depth - predicted) / to->inverse_depth_per_pixel,
                     {1, pixels * at.y() / at.z(), -pixels * at.x() / at.z(), -pixels * predicted}});
    scratch_.push_back(rows_.back().difference);
  }
  if (rows_.size() < kMinJumpMatches) return std::nullopt;
  Eigen::Vector4d values(upper_median(scratch_), 0, 0, 0);
  Eigen::Matrix4d normal;
  for (int round = 0; round < kJumpRounds; ++round) {
    const double scale = std::max(2 * median_distance(values), kLeastJumpScale);
    normal = 1e-6 * Eigen::Matrix4d::Identity();
    Eigen::Vector4d right_side = Eigen::Vector4d::Zero();
    for (const Row& row : rows_) {
      const double distance = (row.difference - row.terms.dot(values)) / scale;
      const double weight = 1 / (1 + distance * distance);
      normal += weight * row.terms * row.terms.transpose();
      right_side += weight * row.difference * row.terms;
    }
    values = normal.inverse() * right_side;
  }
  const double scatter = median_distance(values);
  return ImageJump{values[0], kJumpDeviation * scatter * std::sqrt(normal.inverse()(0, 0)), scatter};
}

}  // namespace quadedge::odometry
