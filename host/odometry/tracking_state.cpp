#include "odometry/tracking_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/numeric.hpp"
#include "odometry/odometry_constants.hpp"
#include "odometry/view_change.hpp"
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

double EarlierRigs::difference(const Kept& one, const Eigen::Isometry3d& world_from_other) {
  return view_change(one.rig.world_from_left().inverse() * world_from_other, one.inverse_depth);
}

void EarlierRigs::remember(const KeyRig& rig, double inverse_depth) {
  if (!kept_.empty() && difference(kept_.back(), rig.world_from_left()) < kSameView) return;
  kept_.push_back({rig, inverse_depth});
  if (kept_.size() <= kEarlierRigs) return;
  std::size_t most_similar = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < kept_.size(); ++i) {
    const double change = difference(kept_[i], kept_[i + 1].rig.world_from_left());
    if (change >= smallest) continue;
    smallest = change;
    most_similar = i;
  }
  kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(most_similar));
}

std::vector<const KeyRig*> EarlierRigs::nearest(const Eigen::Isometry3d& world_from_left) const {
  std::vector<std::pair<double, const KeyRig*>> ordered;
  for (const Kept& kept : kept_) ordered.emplace_back(difference(kept, world_from_left), &kept.rig);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const KeyRig*> result;
  for (std::size_t i = 0; i < std::min(ordered.size(), kEarlierTrials); ++i) result.push_back(ordered[i].second);
  return result;
}

const KeyRig* EarlierRigs::find(const frontend::FrameEdgesHandle& rig) const {
  for (const Kept& kept : kept_)
    if (kept.rig.rig() == rig) return &kept.rig;
  return nullptr;
}

}  // namespace quadedge::odometry
