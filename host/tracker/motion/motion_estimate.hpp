#pragma once
/// \file motion_estimate.hpp  The motion between two rigs that their quads support, and why a motion is refused.

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/uncertain_pose.hpp"
#include "motion/reprojection_terms.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Why a motion is refused: by the estimate from its quads, or afterwards by the search that compares it with others.
enum class Refusal {
  none,
  too_few_quads,   ///< fewer than config.min_inliers
  no_consensus,    ///< no motion reaches config.min_inliers and config.min_inlier_ratio
  badly_spread,    ///< the inliers cover too small a part of the image, or the fit has no finite solution
  little_support,  ///< too few of the edges in view follow it
  duplicate,       ///< another hypothesis had led to it before
  contradicted,    ///< the global matches do not follow it
  ambiguous        ///< another motion may be the camera's, and nothing was known of the motion
};

/// What is known of disparities before a fit: of their common offset, and how far each is off by itself. Systematic
/// errors of edges that look like an offset are alike in all frames of a scene: they are one unknown of unit variance,
/// of which each fit sees a multiple, and do not average out.
struct OffsetPrior {
  OffsetPrior(double variance_px2 = 0, double shared_px = 0, double error_px = 0)
      : variance(variance_px2), shared(shared_px), error(error_px) {}
  double variance;  ///< of the offset [px^2]; 0: there is none
  double shared;    ///< covariance with that unknown, which earlier fits have left [px]
  double error;     ///< see RigEstimate::disparity_error [px]
};

/// A pose and the disparity offset, with their uncertainties.
struct PoseAndOffset {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();  ///< left cameras, metres
  /// [px], added to every right point along its epipolar line, away from the point at infinity.
  double offset = 0;
  /// Of the pose [rad, m], of a left perturbation in the current left frame: what the quads leave open.
  Matrix6d covariance = Matrix6d::Zero();
  /// Change of the pose by a standard deviation of what was unknown of the offset before, and still is.
  Vector6d by_offset = Vector6d::Zero();
  double offset_variance = 0;  ///< [px^2], including the prior
  double offset_shared = 0;    ///< see OffsetPrior
  DisparityErrors errors;      ///< of single disparities
};

/// Motion between two rigs, estimated from their quads.
struct MotionEstimate {
  /// Gamma_current = current_from_previous * Gamma_previous, left cameras, metres. The inliers are those at this pose,
  /// which fits them best with a free disparity offset.
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  double offset = 0;  ///< the free correction of all disparities [px]
  /// What to take over if the motion is adopted. Where an offset looks like a motion, as with all edges at one depth
  /// straight ahead or while the camera hardly moves, small systematic errors of the edges decide about the free
  /// offset. Systematic errors (kSystematicPosition, kSystematicDisparity) are added to its variance. Without a fit of
  /// the offset it is the pose above; without a fit its covariance is zero.
  PoseAndOffset learned;
  std::vector<std::uint8_t> inlier;  ///< one byte per quad
  int inliers = 0;

  /// inliers / quads
  double inlier_ratio() const { return inliers / std::max(1.0, static_cast<double>(inlier.size())); }
  /// Whether enough quads follow it.
  bool has_consensus(const PoseConfig& config) const {
    return inliers >= config.min_inliers && inlier_ratio() >= config.min_inlier_ratio;
  }
  /// The motion to take over: with the offset as far as it was learned.
  RelativePose adopted() const { return {learned.current_from_previous, learned.covariance}; }
};

}  // namespace quadedge::pose
