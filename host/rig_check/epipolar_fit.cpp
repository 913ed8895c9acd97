#include "rig_check/epipolar_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "rig_check/median.hpp"
#include "rig_check/rig_check_constants.hpp"

namespace quadedge::rig_check {
EpipolarFit fit_across(const std::vector<CornerMatch>& matches, int width, int height) {
  EpipolarFit fit;
  if (matches.size() < kMinFitCorners) return fit;
  fit.samples = static_cast<int>(matches.size());
  std::vector<double> distances;
  for (const auto& match : matches) distances.push_back(std::abs(match.across));
  fit.residual = median(distances);
  distances.clear();
  for (const auto& match : matches) distances.push_back(match.across);
  Eigen::Vector3d terms(median(distances), 0, 0);
  const auto row = [&](const CornerMatch& match) {
    return Eigen::Vector3d(1, match.left.x() / width - 0.5, match.left.y() / height - 0.5);
  };
  for (int round = 0; round <= kFitRounds; ++round) {
    distances.clear();
    for (const auto& match : matches) distances.push_back(std::abs(match.across - row(match).dot(terms)));
    fit.scatter = median(distances);
    if (round == kFitRounds) break;
    const double scale = std::max(2 * fit.scatter, kMinScale);
    Eigen::Matrix3d normal = 1e-6 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
    for (const auto& match : matches) {
      const Eigen::Vector3d along = row(match);
      const double distance = (match.across - along.dot(terms)) / scale;
      const double weight = 1 / (1 + distance * distance);
      normal += weight * along * along.transpose();
      right_side += weight * along * match.across;
    }
    terms = normal.ldlt().solve(right_side);
  }
  fit.offset = terms[0];
  fit.slope_x = terms[1];
  fit.slope_y = terms[2];
  return fit;
}

}  // namespace quadedge::rig_check
