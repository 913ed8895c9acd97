#include "odometry/key_rig.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadedge::odometry {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

}  // namespace

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

void KeyRig::start(int frame, const Eigen::Isometry3d& world_from_key) {
  frame_ = frame;
  world_from_key_ = world_from_key;
  first_count_ = -1;
}

bool KeyRig::is_worn(const KeyRigState& state, const OdometryConfig& config) {
  if (first_count_ < 0) first_count_ = state.quads;
  return state.quads < config.key_min_quad_ratio * first_count_ || state.quads < config.key_min_quads ||
         state.inlier_share < config.key_min_inlier_ratio || state.median_parallax > config.key_max_parallax ||
         state.rotation > config.key_max_rotation * kDegree || state.frames >= config.key_max_frames;
}

}  // namespace quadedge::odometry
