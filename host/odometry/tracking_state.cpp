#include "odometry/tracking_state.hpp"

#include <cmath>
#include <vector>

#include "common/numeric.hpp"
#include "quadedge/camera.hpp"
namespace quadedge::odometry {
namespace {

/// A key rig is replaced below this inlier ratio, and above this median parallax [px] or rotation, from which patches
/// look too different to be matched well.
constexpr double kMinInlierRatio = 0.4, kMaxParallax = 16.0, kMaxRotation = 10.0 * kDegree;

}  // namespace

double median_parallax(const StereoEdges& key, const TemporalMatches& quads, std::vector<double>& distances) {
  distances.clear();
  for (std::size_t row = 0; row < quads.size(); ++row) {
    const auto i = static_cast<std::size_t>(quads.previous[row]);
    distances.push_back(std::hypot(quads.left_x[row] - key.left_x[i], quads.left_y[row] - key.left_y[i]));
  }
  return distances.empty() ? 0 : upper_median(distances);
}

bool KeyRig::needs_replacement(const KeyRigFitness& fitness, const OdometryConfig& config) {
  if (origin_ == PoseOrigin::predicted) return true;
  if (first_quads_ < 0) first_quads_ = fitness.quads;
  return fitness.quads < config.key_min_quad_ratio * first_quads_ || fitness.quads < config.key_min_quads ||
         fitness.inlier_ratio < kMinInlierRatio || fitness.median_parallax > kMaxParallax ||
         fitness.rotation > kMaxRotation || fitness.frames >= config.key_max_frames;
}

}  // namespace quadedge::odometry
