#pragma once
/// \file direction_residual.hpp  The residual of one quad's tangent and its Jacobian (doc/method.md section 6).

#include <cstddef>

#include "pose/noise_model.hpp"
#include "pose/plain_vector.hpp"
#include "pose/quads.hpp"

namespace quadedge::pose {

/// Directions of a quad: the rotated previous tangent has to lie in the viewing planes of both current edges.
struct DirectionTerm {
  Vector3 tangent;     ///< previous tangent, direction + slope * ray, not of unit length; previous left frame
  double slope_sigma;  ///< standard deviation of `slope`
  /// Unit normals of the tangent's current viewing planes, divided by the sigma of the direction; current left frame.
  Vector3 left_normal, right_normal;
};

/// \param quad its row in `quads`
DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise);

/// Deviation of the tangent from the left and the right viewing plane, in standard deviations.
struct DirectionResidual {
  double left, right;
  Vector3 left_by_rotation, right_by_rotation;  ///< for a LEFT perturbation of current_from_previous [1/rad]
  double left_by_slope, right_by_slope;         ///< with respect to the slope, in its standard deviations
};

/// \param ray, tangent of the previous left pixel (x, y, 1) and of the term, rotated into the current left frame
[[gnu::always_inline]] inline DirectionResidual direction_residual(const DirectionTerm& term, const Vector3& ray,
                                                                   const Vector3& tangent) {
  return {dot(term.left_normal, tangent),
          dot(term.right_normal, tangent),
          cross(tangent, term.left_normal),
          cross(tangent, term.right_normal),
          dot(term.left_normal, ray) * term.slope_sigma,
          dot(term.right_normal, ray) * term.slope_sigma};
}

}  // namespace quadedge::pose
