/// \file image_jump.cpp  A robust fit of excess disparities: a constant, two rotations and a forward motion.
#include "rig/image_jump.hpp"

#include <Eigen/LU>
#include <cmath>

#include "rig/rig_constants.hpp"

namespace quadedge::rig {

bool ImageJump::is_certain(double least) const {
  const double size = std::abs(shift);
  return size >= least && size >= kJumpSigmas * sigma && kJumpScatter * size >= scatter;
}

std::optional<ImageJump> JumpMeter::measure(const pose::MeasuredEdges& before, const pose::MeasuredEdges& now,
                                            const TemporalMatches& matches, const Eigen::Isometry3d& now_from_before) {
  rows_.clear();
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
  }
  if (rows_.size() < kMinJumpMatches) return std::nullopt;
  fit_.fit(rows_, kLeastJumpScale);
  const double variance = fit_.normal.inverse()(0, 0);
  return ImageJump{fit_.terms[0], kDeviationOfMedian * fit_.scatter * std::sqrt(variance), fit_.scatter};
}

}  // namespace quadedge::rig
