/// \file oriented_point.cpp  Converts between Eigen's types and the plain numbers that the formulas are written for.
#include "geometry/oriented_point.hpp"

#include <cmath>

#include "geometry/stereo_numbers.hpp"

namespace quadedge::pose {

StereoObservation observation_of(const StereoEdges& edges, std::size_t i) {
  return {{edges.left_x[i], edges.left_y[i]},
          {edges.right_x[i], edges.right_y[i]},
          edges.left_direction[i],
          edges.right_direction[i],
          edges.left_scale_shift.empty() ? 0.0 : static_cast<double>(edges.left_scale_shift[i])};
}

ObservedNumbers numbers_of(const StereoObservation& observation) {
  return {observation.left.x(),
          observation.left.y(),
          observation.right.x(),
          observation.right.y(),
          std::cos(observation.left_direction),
          std::sin(observation.left_direction),
          std::cos(observation.right_direction),
          std::sin(observation.right_direction),
          observation.left_scale_shift};
}

std::optional<StereoMeasurement> measurement_of(const ObservedNumbers& edge, const MeasuredNumbers& measured) {
  if (measured.is_valid == 0) return std::nullopt;
  const auto vector = [](const Vector3& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  StereoMeasurement result;
  result.ray = vector(measured.ray);
  result.inverse_depth = measured.inverse_depth;
  result.inverse_depth_per_pixel = measured.inverse_depth_per_pixel;
  result.epipolar_sine = measured.epipolar_sine;
  result.direction = vector(measured.direction);
  result.scale_shift = {measured.scale_shift.x, measured.scale_shift.y};
  result.slope = measured.slope;
  result.slope_per_radian = measured.slope_per_radian;
  result.left_edge = Eigen::Vector2d(edge.left_cos, edge.left_sin).cast<float>();
  result.right_edge = Eigen::Vector2d(edge.right_cos, edge.right_sin).cast<float>();
  result.left_normal = vector(measured.left_normal);
  result.right_normal = vector(measured.right_normal);
  return result;
}

std::optional<StereoMeasurement> measure(const StereoRig& rig, const StereoObservation& observation,
                                         double min_epipolar_angle) {
  const ObservedNumbers edge = numbers_of(observation);
  return measurement_of(edge, measure_numbers(RigNumbers(rig, min_epipolar_angle), edge));
}

std::optional<ImageEdge> project(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_points,
                                 const OrientedPoint& oriented_point) {
  const Eigen::Vector3d point = camera_from_points * oriented_point.point;
  if (!(point.z() > 0)) return std::nullopt;
  const Vector3 moving = image_motion(CameraNumbers(camera), numbers_of(point),
                                      numbers_of(camera_from_points.linear() * oriented_point.tangent));
  const Eigen::Vector2d motion(moving.x, moving.y);
  const double norm = motion.norm();
  if (!(norm > 0)) return std::nullopt;
  return ImageEdge{camera.project(point), motion / norm};
}

}  // namespace quadedge::pose
