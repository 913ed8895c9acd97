#pragma once
/// \file offset_fit.hpp  Least squares over the pose and a common offset of all disparities (doc/method.md section 6).

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pose/covariance.hpp"
#include "pose/reprojection_terms.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Solution of the equations.
struct FreeFit {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();  ///< left cameras, metres
  /// [px], added to every right point along its epipolar line, away from the point at infinity.
  double offset = 0;
};

/// A pose and the disparity offset, with their uncertainties.
struct PoseAndOffset : FreeFit {
  Matrix6d covariance = Matrix6d::Zero();  ///< of the pose [rad, m]
  double offset_variance = 0;              ///< [px^2], including the prior
};

struct OffsetFit {
  FreeFit free;  ///< in: initial pose and offset; out: solution
  /// What is worth learning from it. Where an offset looks like a motion, as with all edges at one depth straight ahead
  /// or while the camera hardly moves, small systematic errors of the edges decide about the free offset. Systematic
  /// errors (kSystematicPosition, kSystematicDisparity) are added to its variance.
  PoseAndOffset learned;
};

/// Continues a fit of `terms` with one more unknown: the common offset of all disparities left by rectification, with a
/// zero-mean prior of variance `variance` [px^2]. Estimated motion along the optical axis scales with depth, and the
/// offset changes large depths more than small ones. Thousands of edges at all depths separate the two; a stationary
/// camera leaves the prior unchanged. On KITTI 06, whose disparities are 0.2 px too small, the motion is 1.2 % too long
/// without the offset.
/// \param covariance the information of the quads is reduced by small_cell_inflation relative to the prior; the
/// covariance of the result is that of a fit with these weights, with errors that scatter by `inflation`. Weighting by
/// the larger factor would make the offset converge more slowly than the data allow (KITTI 01: end drift of 1.9 instead
/// of 1.7 %).
/// \param reprojection_scale ratio of measured to assumed variance of the reprojection residuals
/// \param focal_length of the left camera [px]
/// \returns false if the equations have no solution
bool fit_offset(const PoseConfig& config, const MeasuredCovariance& covariance, double variance,
                double reprojection_scale, double focal_length, ReprojectionTerms& terms, OffsetFit& result);

}  // namespace quadedge::pose
