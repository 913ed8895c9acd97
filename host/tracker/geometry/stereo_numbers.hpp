#pragma once
/// \file stereo_numbers.hpp  measure() in plain numbers, so that loops over edges vectorise, with identical bits at
/// every vector width.

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "geometry/oriented_point.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::pose {

// Scalar 3-vectors. Loops over quads that use them are vectorised across quads, which Eigen's fixed-size vectors
// prevent. All sums are evaluated from the first to the last term.

struct Vector3 {
  double x, y, z;
};

/// References to the three, for row_of() and set_row().
template <class Vector>
[[gnu::always_inline]] inline auto members_of(Vector& vector) {
  return std::tie(vector.x, vector.y, vector.z);
}

[[gnu::always_inline]] inline double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[gnu::always_inline]] inline Vector3 operator*(double factor, const Vector3& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}

/// A symmetric 3 x 3 matrix, stored as its upper triangle.
struct Symmetric3 {
  double xx, xy, xz, yy, yz, zz;
  [[gnu::always_inline]] Vector3 column_x() const { return {xx, xy, xz}; }
  [[gnu::always_inline]] Vector3 column_y() const { return {xy, yy, yz}; }
  [[gnu::always_inline]] Vector3 column_z() const { return {xz, yz, zz}; }
};

[[gnu::always_inline]] inline Symmetric3 operator*(double factor, const Symmetric3& a) {
  return {factor * a.xx, factor * a.xy, factor * a.xz, factor * a.yy, factor * a.yz, factor * a.zz};
}

/// A camera.
struct CameraNumbers {
  explicit CameraNumbers(const PinholeCamera& camera) : fx(camera.fx), fy(camera.fy), cx(camera.cx), cy(camera.cy) {}
  double fx, fy, cx, cy;

  [[gnu::always_inline]] Vector3 ray(double x, double y) const { return {(x - cx) / fx, (y - cy) / fy, 1.0}; }
  /// K^-1 (v, 0): change of the ray for a step in the image.
  [[gnu::always_inline]] Vector3 step(double x, double y) const { return {x / fx, y / fy, 0.0}; }
};

/// Image motion [px] of a point with homogeneous coordinates `y` (camera frame) that moves by `dy`; z is 0.
[[gnu::always_inline]] inline Vector3 image_motion(const CameraNumbers& camera, const Vector3& y, const Vector3& dy) {
  const double inverse = 1.0 / (y.z * y.z);
  return {camera.fx * (dy.x * y.z - y.x * dy.z) * inverse, camera.fy * (dy.y * y.z - y.y * dy.z) * inverse, 0.0};
}

[[gnu::always_inline]] inline double norm(const Vector3& a) { return std::sqrt(dot(a, a)); }
[[gnu::always_inline]] inline Vector3 over(const Vector3& a, double divisor) {
  return {a.x / divisor, a.y / divisor, a.z / divisor};
}
[[gnu::always_inline]] inline Vector3 plus(const Vector3& a, const Vector3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline bool is_finite(double value) {
  return std::abs(value) <= std::numeric_limits<double>::max();
}

/// A rotation.
struct RotationNumbers {
  explicit RotationNumbers(const Eigen::Matrix3d& matrix) {
    for (int row = 0; row < 3; ++row) rows[row] = {matrix(row, 0), matrix(row, 1), matrix(row, 2)};
  }
  Vector3 rows[3];

  [[gnu::always_inline]] Vector3 operator*(const Vector3& v) const {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
};

inline Vector3 numbers_of(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

/// A rig and the limit of measure().
struct RigNumbers {
  RigNumbers(const StereoRig& rig, double min_epipolar_angle)
      : left(rig.left),
        right(rig.right),
        right_from_left(rig.right_from_left.linear()),
        left_from_right(rig.right_from_left.linear().transpose()),
        translation(numbers_of(rig.right_from_left.translation())),
        baseline(numbers_of(rig.right_from_left.linear().transpose() * rig.right_from_left.translation())),
        min_sine(std::sin(min_epipolar_angle)) {}

  CameraNumbers left, right;
  RotationNumbers right_from_left, left_from_right;
  Vector3 translation, baseline;
  double min_sine;
};

/// A stereo edge: positions [px], unit directions in the images, scale-space shift of the left edge.
struct ObservedNumbers {
  double left_x, left_y, right_x, right_y, left_cos, left_sin, right_cos, right_sin, scale_shift;

  template <class Self>
  [[gnu::always_inline]] static auto members(Self& self) {
    return std::tie(self.left_x, self.left_y, self.right_x, self.right_y, self.left_cos, self.left_sin, self.right_cos,
                    self.right_sin, self.scale_shift);
  }
};

ObservedNumbers numbers_of(const StereoObservation& observation);

/// The members of a StereoMeasurement that measure() computes.
struct MeasuredNumbers {
  double is_valid;  ///< 1; if 0, the edge has no measurement and the other members are arbitrary
  Vector3 ray;
  double inverse_depth, inverse_depth_per_pixel, epipolar_sine;
  Vector3 direction, scale_shift;  ///< z is 0
  double slope, slope_per_radian;
  Vector3 left_normal, right_normal;

  template <class Self>
  [[gnu::always_inline]] static auto members(Self& self) {
    return std::tuple_cat(std::tie(self.is_valid), members_of(self.ray),
                          std::tie(self.inverse_depth, self.inverse_depth_per_pixel, self.epipolar_sine),
                          members_of(self.direction), members_of(self.scale_shift),
                          std::tie(self.slope, self.slope_per_radian), members_of(self.left_normal),
                          members_of(self.right_normal));
  }
};

/// The measurement of an edge; nothing if it has none.
std::optional<StereoMeasurement> measurement_of(const ObservedNumbers& edge, const MeasuredNumbers& measured);

/// See measure().
[[gnu::always_inline]] inline MeasuredNumbers measure_numbers(const RigNumbers& rig, const ObservedNumbers& edge) {
  MeasuredNumbers result;
  result.ray = rig.left.ray(edge.left_x, edge.left_y);

  // The right homogeneous point is at_infinity + rho * translation; as rho varies, its image moves along a fixed line.
  const Vector3 at_infinity = rig.right_from_left * result.ray, &translation = rig.translation;
  const CameraNumbers& right = rig.right;
  const Vector3 towards = {right.fx * (translation.x * at_infinity.z - at_infinity.x * translation.z),
                           right.fy * (translation.y * at_infinity.z - at_infinity.y * translation.z), 0.0};
  const double line_norm = norm(towards);
  const Vector3 line = over(towards, line_norm);
  const double position = line.x * (edge.right_x - right.cx) + line.y * (edge.right_y - right.cy);
  const Vector3 weights = {line.x * right.fx, line.y * right.fy, -position};
  result.inverse_depth = -dot(weights, at_infinity) / dot(weights, translation);
  const Vector3 in_right = plus(at_infinity, result.inverse_depth * translation);
  result.inverse_depth_per_pixel = 1.0 / norm(image_motion(right, in_right, translation));

  // Both edges have to cross their epipolar lines.
  const Vector3 left_line = image_motion(rig.left, result.ray, rig.baseline);
  const double left_crossing = std::abs(edge.left_cos * left_line.y - edge.left_sin * left_line.x);
  result.epipolar_sine = std::abs(edge.right_cos * line.y - edge.right_sin * line.x);

  const double drift = edge.scale_shift;  // towards the bright side
  result.scale_shift = rig.left.step(drift * -edge.left_sin, drift * edge.left_cos);
  const Vector3 left_step = rig.left.step(edge.left_cos, edge.left_sin);
  const double left_scale = 1.0 / norm(left_step);
  result.direction = left_scale * left_step;
  const Vector3 left_normal = cross(result.direction, result.ray);
  result.left_normal = over(left_normal, norm(left_normal));

  const Vector3 right_ray = right.ray(edge.right_x, edge.right_y);
  const Vector3 normal = rig.left_from_right * cross(right.step(edge.right_cos, edge.right_sin), right_ray);
  const Vector3 normal_turn = rig.left_from_right * cross(right.step(-edge.right_sin, edge.right_cos), right_ray);
  result.right_normal = over(normal, norm(normal));

  // Solves normal . (direction + slope * ray) = 0, and its derivatives with respect to the two directions.
  const double along_ray = dot(normal, result.ray);
  result.slope = -dot(normal, result.direction) / along_ray;
  const double by_right = dot(normal_turn, plus(result.direction, result.slope * result.ray)) / along_ray;
  const double by_left = dot(normal, rig.left.step(-edge.left_sin, edge.left_cos)) * left_scale / along_ray;
  result.slope_per_radian = std::sqrt(by_right * by_right + by_left * by_left);
  const bool is_valid = (line_norm > 0) & (result.inverse_depth > 0) & is_finite(result.inverse_depth) &
                        (in_right.z > 0) & is_finite(result.inverse_depth_per_pixel) &
                        !(left_crossing < rig.min_sine * norm(left_line)) & (result.epipolar_sine > 0) &
                        !(result.epipolar_sine < rig.min_sine) & is_finite(result.slope) &
                        is_finite(result.slope_per_radian);
  result.is_valid = is_valid ? 1 : 0;
  return result;
}

}  // namespace quadedge::pose
