#pragma once
/// \file motion.hpp  The motion between two rigs from their quads (doc/method.md section 6).

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "motion/motion_estimate.hpp"
#include "motion/quads.hpp"
#include "motion/ransac.hpp"
#include "motion/refinement.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Estimates the motion: consensus of two-quad samples, followed by least squares over all inliers.
/// With config.refine off, the pose is the best of the paper's two-quad samples and their local optimisations over at
/// most kPreviewQuads, compared by their cost over all quads; there is no fit over all inliers and no covariance.
/// Buffers are kept between calls.
class MotionEstimator {
 public:
  /// \param initial a hypothesis besides the samples, current_from_previous: a predicted or frame-to-frame pose
  /// \param offset what is known of the disparity offset, relative to that of `rig`
  /// \param motion is replaced; unless the result is Refusal::none, its pose is the identity and its covariance zero
  /// \returns why there is no motion, or Refusal::none
  Refusal estimate(const StereoRig& rig, const QuadObservations& quads, const PoseConfig& config, std::uint64_t seed,
                   const std::optional<Eigen::Isometry3d>& initial, const OffsetPrior& offset, MotionEstimate& motion,
                   RefinementGoal goal = RefinementGoal::pose_and_covariance);

 private:
  ConsensusWorkspace consensus_;
  RefinementWorkspace refinement_;
};

}  // namespace quadedge::pose
