#pragma once
/// \file offset_fit.hpp  Least squares over the pose and an offset that all disparities share (doc/method.md section
/// 6).

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pose/covariance.hpp"
#include "pose/reprojection_terms.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// A pose and the offset of all disparities.
struct OffsetFit {
  /// In: the start; out: the pose with the offset. Left cameras, metres.
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  /// In and out as well; px, added to every right point along its epipolar line, away from the point at infinity.
  double offset = 0;
  /// Of (pose, offset) [rad, m, px], with the prior on the offset.
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  double offset_variance = 0;  ///< px^2, by the weights alone
};

/// Continues a fit of `terms` with one more unknown: the offset of all disparities that a rectification leaves, with a
/// prior of variance `variance` [px^2] around zero. Motion along the optical axis scales with depth, and the offset
/// changes the depths of far points more than those of near ones; thousands of edges at all depths tell the two apart,
/// and over a standing camera the prior stays. KITTI 06: the motion comes out 1.2 % too long without it, since
/// disparities are 0.2 px too small.
/// \param covariance what the quads tell counts less against the prior by its small_cell_inflation; the covariance of
/// the result is that of a fit weighed so while the quads' errors scatter by its inflation. Weighing by the larger
/// factor would learn the offset more slowly than the data allow (KITTI 01: end drift 1.9 instead of 1.7 %).
/// \param reprojection_scale measured variance of the reprojection residuals over the assumed one
/// \returns false, with `result` unchanged, when the equations have no solution.
bool fit_offset(const PoseConfig& config, const MeasuredCovariance& covariance, double variance,
                double reprojection_scale, ReprojectionTerms& terms, OffsetFit& result);

}  // namespace quadedge::pose
