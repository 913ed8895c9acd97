#include "odometry/key_rig.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadedge::odometry {

double median_parallax(const StereoEdges& key, const TemporalMatches& quads, std::vector<double>& distances) {
  distances.clear();
  for (std::size_t row = 0; row < quads.size(); ++row) {
    const auto i = static_cast<std::size_t>(quads.previous[row]);
    distances.push_back(std::hypot(quads.left_x[row] - key.left_x[i], quads.left_y[row] - key.left_y[i]));
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

bool KeyRig::needs_replacement(const KeyRigFitness& fitness, const OdometryConfig& config) {
  if (origin_ == PoseOrigin::predicted) return true;
  if (first_quads_ < 0) first_quads_ = fitness.quads;
  return fitness.quads < config.key_min_quad_ratio * first_quads_ || fitness.quads < config.key_min_quads ||
         fitness.inlier_ratio < config.key_min_inlier_ratio || fitness.median_parallax > config.key_max_parallax ||
         fitness.rotation > config.key_max_rotation_rad() || fitness.frames >= config.key_max_frames;
}

}  // namespace quadedge::odometry
