#include "pose/direction_residual.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace quadedge::pose {

DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise) {
  const StereoMeasurement &previous = quads.previous[quad], &current = quads.current[quad];
  const double plane_weight = 1.0 / (std::sqrt(2.0) * noise.direction);  // the directions at both times are noisy
  DirectionTerm term;
  term.ray = previous.ray;
  term.tangent = previous.direction + previous.slope * previous.ray;
  term.slope_sigma = previous.slope_per_radian * noise.direction;
  term.left_normal = current.left_normal * plane_weight;
  term.right_normal = current.right_normal * plane_weight;
  return term;
}

void direction_residual(const DirectionTerm& term, const Eigen::Matrix3d& rotation, DirectionResidual& result) {
  const Eigen::Vector3d ray = rotation * term.ray, tangent = rotation * term.tangent;
  result.value << term.left_normal.dot(tangent), term.right_normal.dot(tangent);
  result.by_rotation.row(0) = tangent.cross(term.left_normal).transpose();
  result.by_rotation.row(1) = tangent.cross(term.right_normal).transpose();
  result.by_slope << term.left_normal.dot(ray), term.right_normal.dot(ray);
  result.by_slope *= term.slope_sigma;
}

}  // namespace quadedge::pose
