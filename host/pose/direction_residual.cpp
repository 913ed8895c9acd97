#include "pose/direction_residual.hpp"

#include <cmath>

namespace quadedge::pose {

DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise) {
  const StereoMeasurement &previous = quads.previous[quad], &current = quads.current[quad];
  const double plane_weight = 1.0 / (std::sqrt(2.0) * noise.direction);  // the directions at both times are noisy
  const auto vector = [](const Eigen::Vector3d& v) -> Vector3 { return {v.x(), v.y(), v.z()}; };
  return {vector(previous.direction + previous.slope * previous.ray), previous.slope_per_radian * noise.direction,
          vector(current.left_normal * plane_weight), vector(current.right_normal * plane_weight)};
}

}  // namespace quadedge::pose
