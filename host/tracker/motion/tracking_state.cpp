/// \file tracking_state.cpp  Repeats the last motion over whole and partial intervals; limits that end a keyframe.
#include "motion/tracking_state.hpp"

#include <cmath>
#include <vector>

#include "common/numeric.hpp"
#include "quadedge/camera.hpp"
namespace quadedge::odometry {
namespace {

/// A keyframe is replaced below this inlier ratio, and above this median parallax [px] or rotation, from which patches
/// look too different to be matched well.
constexpr double kMinInlierRatio = 0.4, kMaxParallax = 16.0, kMaxRotation = 10.0 * kDegree;

/// Stamps that jitter by up to this part of a frame interval count as even, as those that a driver takes do.
constexpr double kJitter = 0.25;
/// Nobody moves evenly over more intervals than these.
constexpr double kLongestStep = 10;

}  // namespace

std::optional<Eigen::Isometry3d> ConstantVelocity::predict(TimeStep step) const {
  if (!one_interval_) return std::nullopt;
  double intervals = step.frames;
  if (interval_ns_ > 0 && step.ns > 0) {
    intervals = static_cast<double>(step.ns) / interval_ns_;
    const double whole = std::round(intervals);
    if (whole >= 1 && std::abs(intervals - whole) <= kJitter) intervals = whole;
    if (intervals > kLongestStep) return std::nullopt;
  }
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const int whole = static_cast<int>(intervals);
  for (int i = 0; i < whole; ++i) motion = *one_interval_ * motion;
  const double rest = intervals - whole;
  return rest > 0 ? divided(*one_interval_, 1 / rest) * motion : motion;
}

Eigen::Isometry3d ConstantVelocity::divided(const Eigen::Isometry3d& motion, double parts) {
  const Eigen::AngleAxisd rotation(motion.linear());
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(rotation.angle() / parts, rotation.axis()).toRotationMatrix();
  result.translation() = motion.translation() / parts;
  return result;
}

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
