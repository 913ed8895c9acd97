#include "pose/oriented_point.hpp"

#include <cmath>

namespace quadedge::pose {

namespace {

/// K^-1 (v, 0): change of the ray for a step in the image.
Eigen::Vector3d image_step(const PinholeCamera& camera, const Eigen::Vector2d& step) {
  return {step.x() / camera.fx, step.y() / camera.fy, 0.0};
}

/// Image motion [px] of a point with homogeneous coordinates `y` (camera frame) that moves by `dy`.
Eigen::Vector2d image_motion(const PinholeCamera& camera, const Eigen::Vector3d& y, const Eigen::Vector3d& dy) {
  const double inverse = 1.0 / (y.z() * y.z());
  return {camera.fx * (dy.x() * y.z() - y.x() * dy.z()) * inverse,
          camera.fy * (dy.y() * y.z() - y.y() * dy.z()) * inverse};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::optional<StereoMeasurement> measure(const StereoRig& rig, const StereoObservation& observation,
                                         double min_epipolar_angle) {
  const Eigen::Matrix3d rotation = rig.right_from_left.linear();
  const Eigen::Vector3d translation = rig.right_from_left.translation();
  const double min_sine = std::sin(min_epipolar_angle);

  StereoMeasurement result;
  result.ray = rig.left.ray(observation.left);

  // The right homogeneous point is at_infinity + rho * translation; as rho varies, its image moves along a fixed line.
  const Eigen::Vector3d at_infinity = rotation * result.ray;
  const PinholeCamera& right = rig.right;
  Eigen::Vector2d line(right.fx * (translation.x() * at_infinity.z() - at_infinity.x() * translation.z()),
                       right.fy * (translation.y() * at_infinity.z() - at_infinity.y() * translation.z()));
  const double line_norm = line.norm();
  if (!(line_norm > 0)) return std::nullopt;
  line /= line_norm;
  const double position = line.x() * (observation.right.x() - right.cx) + line.y() * (observation.right.y() - right.cy);
  const Eigen::Vector3d weights(line.x() * right.fx, line.y() * right.fy, -position);
  result.inverse_depth = -weights.dot(at_infinity) / weights.dot(translation);
  if (!(result.inverse_depth > 0) || !std::isfinite(result.inverse_depth)) return std::nullopt;
  const Eigen::Vector3d in_right = at_infinity + result.inverse_depth * translation;
  if (!(in_right.z() > 0)) return std::nullopt;
  result.inverse_depth_per_pixel = 1.0 / image_motion(right, in_right, translation).norm();
  if (!std::isfinite(result.inverse_depth_per_pixel)) return std::nullopt;

  // Both edges have to cross their epipolar lines.
  const Eigen::Vector2d left_edge(std::cos(observation.left_direction), std::sin(observation.left_direction));
  const Eigen::Vector2d right_edge(std::cos(observation.right_direction), std::sin(observation.right_direction));
  const Eigen::Vector3d baseline = rotation.transpose() * translation;
  result.left_edge = left_edge.cast<float>();
  result.right_edge = right_edge.cast<float>();
  const Eigen::Vector2d left_line = image_motion(rig.left, result.ray, baseline);
  if (std::abs(cross(left_edge, left_line)) < min_sine * left_line.norm()) return std::nullopt;
  result.epipolar_sine = std::abs(cross(right_edge, line));
  if (!(result.epipolar_sine > 0) || result.epipolar_sine < min_sine) return std::nullopt;

  const Eigen::Vector2d to_bright_side(-left_edge.y(), left_edge.x());
  result.scale_drift = image_step(rig.left, observation.left_scale_drift * to_bright_side).head<2>();
  const Eigen::Vector3d left_step = image_step(rig.left, left_edge);
  const double left_scale = 1.0 / left_step.norm();
  result.direction = left_step * left_scale;
  result.left_normal = result.direction.cross(result.ray).normalized();

  const Eigen::Vector3d right_ray = right.ray(observation.right);
  const Eigen::Vector3d right_step = image_step(right, right_edge);
  const Eigen::Vector3d right_turn = image_step(right, {-right_edge.y(), right_edge.x()});
  const Eigen::Vector3d normal = rotation.transpose() * right_step.cross(right_ray);
  const Eigen::Vector3d normal_turn = rotation.transpose() * right_turn.cross(right_ray);
  result.right_normal = normal.normalized();

  // Solves normal . (direction + slope * ray) = 0, and its derivatives with respect to the two directions.
  const double along_ray = normal.dot(result.ray);
  result.slope = -normal.dot(result.direction) / along_ray;
  const double by_right = normal_turn.dot(result.direction + result.slope * result.ray) / along_ray;
  const double by_left = normal.dot(image_step(rig.left, {-left_edge.y(), left_edge.x()})) * left_scale / along_ray;
  result.slope_per_radian = std::sqrt(by_right * by_right + by_left * by_left);
  if (!std::isfinite(result.slope) || !std::isfinite(result.slope_per_radian)) return std::nullopt;
  return result;
}

std::optional<ImageEdge> project(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_points,
                                 const OrientedPoint& oriented_point) {
  const Eigen::Vector3d point = camera_from_points * oriented_point.point;
  if (!(point.z() > 0)) return std::nullopt;
  const Eigen::Vector2d motion = image_motion(camera, point, camera_from_points.linear() * oriented_point.tangent);
  const double norm = motion.norm();
  if (!(norm > 0)) return std::nullopt;
  return ImageEdge{camera.project(point), motion / norm};
}

}  // namespace quadedge::pose
