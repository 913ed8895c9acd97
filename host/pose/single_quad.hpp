#pragma once
/// \file single_quad.hpp  Proposition 1: what one quad says about the motion (paper section 4, Equations 4 to 7).

#include <Eigen/Geometry>

#include "pose/oriented_point.hpp"

namespace quadedge::pose {

/// The shortest rotation that takes unit vector `from` to unit vector `to` (Equation 6), accurate up to and including
/// to = -from, where it is a half turn about some axis orthogonal to `from`.
Eigen::Matrix3d align(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// One member of the family of motions that take `previous` to `current`, points (metres) and unit tangents both:
///   R(theta) = Rot(current.tangent, theta) * align(previous.tangent, current.tangent),  T(theta) = Gamma_bar -
///   R(theta) Gamma.
/// The translation uses the POINTS; the tangents that the paper prints in Equation 7 cannot give one.
/// \param theta radians. \returns current_from_previous, left cameras.
Eigen::Isometry3d family(const OrientedPoint& previous, const OrientedPoint& current, double theta);

}  // namespace quadedge::pose
