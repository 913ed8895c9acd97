#pragma once
/// \file motion.hpp  The motion between two rigs from their quads (doc/method.md section 6): the entry point of
/// host/pose.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "pose/quads.hpp"
#include "pose/ransac.hpp"
#include "pose/refinement.hpp"
#include "pose/uncertain_pose.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Outcome of a motion estimate.
enum class MotionStatus {
  ok,
  too_few_quads,  ///< fewer quads than config.min_inliers
  no_consensus,   ///< no motion reaches config.min_inliers and config.min_inlier_ratio
  badly_spread,   ///< the inliers cover too small a part of the image, or the fit has no finite solution
};

/// Motion between two rigs, estimated from their quads.
struct MotionEstimate {
  MotionStatus status = MotionStatus::too_few_quads;
  /// Gamma_current = current_from_previous * Gamma_previous, left cameras, metres. Identity unless status is ok. The
  /// inliers are those at this pose, which fits them best with a free disparity offset.
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  /// Covariance (rotation [rad^2], translation [m^2]) of a left perturbation in the current left frame; zero unless
  /// status is ok and config.refine is on.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<std::uint8_t> inlier;  ///< one byte per quad, at the estimated pose (for any status)
  int inliers = 0;
  double inlier_ratio = 0;               ///< inliers / quads
  double offset = 0;                     ///< free correction of all disparities, see OffsetFit [px]
  std::optional<PoseAndOffset> learned;  ///< what to take over if the motion is adopted, see OffsetFit
  int hypotheses = 0, draws = 0;         ///< numbers of the consensus search, see Consensus

  /// The motion to take over: with the offset as far as it was learned, if there was a fit with an offset.
  RelativePose adopted() const {
    return {learned ? learned->current_from_previous : current_from_previous, covariance};
  }
};

/// Estimates the motion: consensus of two-quad samples, followed by least squares over all inliers.
/// With config.refine off, the pose is the best of the paper's two-quad samples and their local optimisations over at
/// most kPreviewQuads, compared by their cost over all quads; there is no fit over all inliers and no covariance.
/// Buffers are kept between calls.
class MotionEstimator {
 public:
  /// \param initial a hypothesis besides the samples, current_from_previous: a predicted or frame-to-frame pose
  /// \param offset_variance variance of the disparity offset [px^2]; 0: disparities are assumed exact
  /// \param estimate is replaced
  void estimate(const StereoRig& rig, const QuadObservations& quads, const PoseConfig& config, std::uint64_t seed,
                const std::optional<Eigen::Isometry3d>& initial, double offset_variance, MotionEstimate& estimate,
                RefinementGoal goal = RefinementGoal::pose_and_covariance);

 private:
  ConsensusWorkspace consensus_;
  RefinementWorkspace refinement_;
};

}  // namespace quadedge::pose
