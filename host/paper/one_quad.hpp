#pragma once
/// \file one_quad.hpp  Proposition 1: the motions compatible with one quad (paper section 4, Equations 4 to 7).

#include <Eigen/Geometry>

#include "pose/oriented_point.hpp"

namespace quadedge::paper {

/// The shortest rotation from unit vector `from` to unit vector `to` (Equation 6), accurate up to and including to =
/// -from, for which it is a half turn about some axis orthogonal to `from`.
Eigen::Matrix3d align(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// One member of the family of motions that map `previous` to `current`, both points (metres) and unit tangents:
///   R(theta) = Rot(current.tangent, theta) align(previous.tangent, current.tangent),
///   T(theta) = Gamma_bar - R(theta) Gamma.
/// The translation uses the points; the tangents printed in Equation 7 cannot determine one. \param theta [rad]
/// \returns current_from_previous, left cameras
Eigen::Isometry3d motion_of_one_quad(const pose::OrientedPoint& previous, const pose::OrientedPoint& current,
                                     double theta);

}  // namespace quadedge::paper
