/// \file learned_rig.cpp  Divides what a frame shows between offset and displacement, by their variances.
#include "motion/learned_rig.hpp"

#include <cmath>

#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Errors of single disparities before a recording has shown any [px], the weight of that, and the weight above which
/// older ones count less [1/px^4]: a frame of a car has about 60. Quads that tell less of an error than
/// kLeastInformation [1/px^2], as at rest, show how well other noise is known rather than the rig.
constexpr double kErrorPrior = 0.3, kErrorPriorWeight = 40, kMostErrorWeight = 2000, kLeastInformation = 2;

}  // namespace

LearnedRig::LearnedRig(const PoseConfig& config)
    : value_(config.disparity_offset), prior_(config.disparity_offset_sigma * config.disparity_offset_sigma) {
  restart();
}

RigEstimate LearnedRig::estimate() const {
  RigEstimate estimate;
  estimate.disparity_offset = value_;
  estimate.disparity_offset_sigma = std::sqrt(prior_.variance);
  estimate.disparity_offset_shared = prior_.shared;
  estimate.disparity_error = prior_.error;
  estimate.disparity_error_weight = error_weight_;
  return estimate;
}

DisplacementLimits LearnedRig::displacement_limits() const {
  return displaced_ < kDisplacedFrames ? DisplacementLimits{kFirstJump, kFirstGain} : DisplacementLimits{kLaterJump, 1};
}

/// Standard deviation of the displacements.
double LearnedRig::swing() const {
  return std::sqrt((kSwingFrames * kSwing * kSwing + squares_) / (kSwingFrames + frames_));
}

RigEstimate LearnedRig::refined(RigEstimate frame, const RigEstimate& base, const pose::PoseAndOffset& learned) {
  const auto& [variance_seen, information] = learned.errors;
  if (information > kLeastInformation) {
    const double before = frame.disparity_error_weight, known = frame.disparity_error * frame.disparity_error,
                 weight = std::pow(information / (1 + std::fmax(known, variance_seen) * information), 2);
    frame.disparity_error = std::sqrt(std::fmax(0, (before * known + weight * variance_seen) / (before + weight)));
    frame.disparity_error_weight = std::fmin(before + weight, kMostErrorWeight);
  }
  if (!(learned.offset_variance > 0)) return frame;
  const double variance = frame.disparity_offset_sigma * frame.disparity_offset_sigma,
               displaced = base.displacement_sigma * base.displacement_sigma, share = variance / (variance + displaced),
               lost = std::fmax(0.0, variance + displaced - learned.offset_variance);
  frame.disparity_offset += share * learned.offset;
  frame.disparity_offset_sigma = std::sqrt(variance - share * share * lost);
  frame.disparity_offset_shared = share * learned.offset_shared;
  if (frame.displacement == 0) return frame;
  frame.displacement -= (1 - share) * learned.offset;
  const double own = frame.displacement_sigma * frame.displacement_sigma;
  frame.displacement_sigma = std::sqrt(std::fmax(0.0, own - (1 - share) * (1 - share) * lost));
  return frame;
}

RigEstimate LearnedRig::anchored(RigEstimate frame) {
  prior_.error = frame.disparity_error;
  error_weight_ = frame.disparity_error_weight;
  if (displaced_ == 0 && frame.displacement == 0) return frame;
  constexpr double kKept = 1 - 1.0 / kSwingMemory;
  frames_ = kKept * frames_ + 1;
  squares_ = kKept * squares_ + frame.displacement * frame.displacement;
  if (frame.displacement == 0) return frame;
  ++displaced_;
  const double variance = frame.displacement_sigma * frame.displacement_sigma,
               kept = swing() * swing() / (swing() * swing() + variance);
  frame.displacement *= kept;
  frame.displacement_sigma *= std::sqrt(kept);
  return frame;
}

void LearnedRig::adopt(const RigEstimate& frame) {
  if (!(prior_.variance > 0)) return;
  value_ = frame.disparity_offset;
  prior_ = {frame.disparity_offset_sigma * frame.disparity_offset_sigma, frame.disparity_offset_shared, prior_.error};
}

void LearnedRig::restart() {
  prior_.error = kErrorPrior;
  error_weight_ = kErrorPriorWeight;
  displaced_ = 0;
  frames_ = squares_ = 0;
}

}  // namespace quadedge::rig
