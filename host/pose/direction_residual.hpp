#pragma once
/// \file direction_residual.hpp  The residual of one quad's tangent and its Jacobian (doc/method.md section 6).

#include <Eigen/Core>
#include <cstddef>

#include "pose/noise_model.hpp"
#include "pose/quads.hpp"

namespace quadedge::pose {

/// What a quad says about the motion by its directions: the previous tangent, turned, lies in the viewing planes of
/// both current edges.
struct DirectionTerm {
  Eigen::Vector3d ray;      ///< of the previous left pixel, previous left frame
  Eigen::Vector3d tangent;  ///< previous, direction + slope * ray, not of unit norm
  double slope_sigma = 0;   ///< standard deviation of `slope` in it
  /// Unit normals of the current viewing planes of the tangent over the direction's sigma, current left frame.
  Eigen::Vector3d left_normal, right_normal;
};

/// \param quad its row in `quads`
DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise);

/// Tangent out of the left and the right viewing plane, in standard deviations.
struct DirectionResidual {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_rotation;  ///< of a LEFT perturbation of current_from_previous [1/rad]
  Eigen::Vector2d by_slope;                 ///< by the slope unknown, in its standard deviations
};

/// \param rotation R of current_from_previous
void direction_residual(const DirectionTerm& term, const Eigen::Matrix3d& rotation, DirectionResidual& result);

}  // namespace quadedge::pose
