#pragma once
/// \file reprojection_jacobian.hpp  The full Jacobian of a reprojection residual, with which tests build the normal
/// equations that host/tracker/motion/ computes lane by lane.

#include "motion/residuals.hpp"
#include "testing.hpp"

namespace quadedge::pose {

/// Residuals of a quad at a pose, with the full Jacobian.
struct ReprojectionJacobian {
  Eigen::Vector3d value;                ///< across, along, inverse depth; in standard deviations
  Eigen::Matrix<double, 3, 6> by_pose;  ///< with respect to (rotation [rad], translation [m]) of a left perturbation
  Eigen::Vector3d by_depth, by_offset;  ///< see ReprojectionResidual
};

/// \param current_from_previous left cameras, metres \param depth the depth unknown of the quad,
/// in standard deviations of the previous inverse depth
/// \returns false for a point that is not in front of the current left camera
inline bool reprojection_jacobian(const ReprojectionTerm& term, const Eigen::Isometry3d& current_from_previous,
                                  double depth, ReprojectionJacobian& result) {
  const Eigen::Vector3d translation = current_from_previous.translation();
  const double rho = term.inverse_depth + depth * term.inverse_depth_sigma;
  const Eigen::Vector3d ray = current_from_previous.linear() * Eigen::Vector3d(term.ray_x, term.ray_y, 1);
  const Eigen::Vector3d point = ray + rho * translation;
  const ReprojectionResidual residual = reprojection_residual(term, {point.x(), point.y(), point.z()}, rho,
                                                              {translation.x(), translation.y(), translation.z()});
  if (!residual.in_front) return false;
  const auto vector = [](const Residuals& r) { return Eigen::Vector3d(r.across, r.along, r.inverse_depth); };
  result.value = vector(residual.value);
  result.by_depth = vector(residual.by_depth);
  result.by_offset = vector(residual.by_offset);
  const Vector3 gradients[3] = {residual.across_by_point, residual.along_by_point, {0, 0, residual.inverse_depth_by_z}};
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d by_point(gradients[row].x, gradients[row].y, gradients[row].z);
    result.by_pose.row(row) << point.cross(by_point).transpose(), rho * by_point.transpose();
  }
  return true;
}

}  // namespace quadedge::pose
