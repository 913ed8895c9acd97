#pragma once
/// \file direction_residual.hpp  The residual of one quad's tangent and its Jacobian (doc/method.md section 6).

#include <Eigen/Core>
#include <cstddef>

#include "pose/noise_model.hpp"
#include "pose/quads.hpp"

namespace quadedge::pose {

/// Directions of a quad: the rotated previous tangent has to lie in the viewing planes of both current edges.
struct DirectionTerm {
  Eigen::Vector3d ray;      ///< of the previous left pixel, previous left frame
  Eigen::Vector3d tangent;  ///< previous tangent, direction + slope * ray, not of unit length
  double slope_sigma = 0;   ///< standard deviation of `slope`
  /// Unit normals of the tangent's current viewing planes, divided by the sigma of the direction; current left frame.
  Eigen::Vector3d left_normal, right_normal;
};

/// \param quad its row in `quads`
DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise);

/// Deviation of the tangent from the left and the right viewing plane, in standard deviations.
struct DirectionResidual {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_rotation;  ///< with respect to a LEFT perturbation of current_from_previous [1/rad]
  Eigen::Vector2d by_slope;                 ///< with respect to the slope, in its standard deviations
};

/// \param rotation R of current_from_previous
void direction_residual(const DirectionTerm& term, const Eigen::Matrix3d& rotation, DirectionResidual& result);

}  // namespace quadedge::pose
