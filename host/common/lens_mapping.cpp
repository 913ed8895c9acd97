#include "common/lens_mapping.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "quadedge/pi.hpp"

namespace quadedge {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

BrownDistortion brown_of(const Lens& lens) {
  const std::size_t first = lens.model == LensModel::omnidirectional ? 1 : 0;
  const bool has_one = lens.model == LensModel::radial_tangential || first == 1;
  return {lens.parameters.data() + first, has_one ? lens.parameters.size() - first : 0};
}

/// Angle up to which theta (1 + k1 theta^2 + ... + k4 theta^8) increases, at most a half turn.
double growing_angle(const std::vector<double>& k) {
  const auto grows = [&](double angle) {
    const double s = angle * angle;
    return 1 + s * (3 * k[0] + s * (5 * k[1] + s * (7 * k[2] + s * 9 * k[3]))) > 0;
  };
  constexpr double kStep = 0.01;
  for (double angle = kStep; angle < kPi; angle += kStep)
    if (!grows(angle)) return angle - kStep;
  return kPi;
}

}  // namespace

const char* to_string(LensModel model) {
  switch (model) {
    case LensModel::radial_tangential: return "radtan";
    case LensModel::equidistant: return "equidistant";
    case LensModel::field_of_view: return "fov";
    case LensModel::double_sphere: return "double-sphere";
    case LensModel::omnidirectional: return "omni";
  }
  return "";
}

bool Lens::is_pinhole() const {
  return model == LensModel::radial_tangential &&
         std::all_of(parameters.begin(), parameters.end(), [](double k) { return k == 0; });
}

LensMapping::LensMapping(const Lens& lens) : lens_(lens), brown_(brown_of(lens)) {
  if (lens.model == LensModel::equidistant) widest_angle_ = growing_angle(lens.parameters);
}

double LensMapping::axial_scale() const {
  switch (lens_.model) {
    case LensModel::radial_tangential:
    case LensModel::equidistant: return 1;
    case LensModel::field_of_view: return 2 * std::tan(0.5 * lens_.parameters[0]) / lens_.parameters[0];
    case LensModel::double_sphere:
    case LensModel::omnidirectional: return 1 / (1 + lens_.parameters[0]);
  }
  return 1;
}

double LensMapping::equidistant_radius(double angle) const {
  const auto& k = lens_.parameters;
  const double s = angle * angle;
  return angle * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
}

/// By bisection, because the radius increases with the angle.
double LensMapping::equidistant_angle(double radius) const {
  double low = 0, high = widest_angle_;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (equidistant_radius(middle) < radius ? low : high) = middle;
  }
  return low;
}

std::optional<Vector2d> LensMapping::to_plane(const Vector3d& unit) const {
  const auto& k = lens_.parameters;
  const double side = unit.head<2>().norm(), z = unit.z();
  switch (lens_.model) {
    case LensModel::radial_tangential:
      if (z <= 0 || side > brown_.radius_limit() * z) return std::nullopt;
      return brown_.distort(unit.hnormalized());
    case LensModel::equidistant: {
      const double angle = std::atan2(side, z);
      if (angle > widest_angle_) return std::nullopt;
      return side == 0 ? Vector2d(0, 0) : Vector2d(unit.head<2>() * (equidistant_radius(angle) / side));
    }
    case LensModel::field_of_view: {
      if (z <= 0) return std::nullopt;
      const double radius = std::atan2(2 * std::tan(0.5 * k[0]) * side, z) / k[0];
      return side == 0 ? Vector2d(0, 0) : Vector2d(unit.head<2>() * (radius / side));
    }
    case LensModel::double_sphere: {
      const double xi = k[0], alpha = k[1], along = xi + z, second = std::hypot(side, along);
      const double w1 = alpha <= 0.5 ? alpha / (1 - alpha) : (1 - alpha) / alpha;
      const double w2 = (w1 + xi) / std::sqrt(2 * w1 * xi + xi * xi + 1);
      if (z <= -w2) return std::nullopt;
      return Vector2d(unit.head<2>() / (alpha * second + (1 - alpha) * along));
    }
    case LensModel::omnidirectional: {
      const double xi = k[0], below = z + xi;
      if (below <= 0 || (xi > 1 && z <= -1 / xi) || side > brown_.radius_limit() * below) return std::nullopt;
      return brown_.distort(unit.head<2>() / below);
    }
  }
  return std::nullopt;
}

std::optional<Vector3d> LensMapping::from_double_sphere(double square, const Vector2d& position) const {
  const double xi = lens_.parameters[0], alpha = lens_.parameters[1];
  if (alpha > 0.5 && square * (2 * alpha - 1) > 1) return std::nullopt;
  const double z = (1 - alpha * alpha * square) / (alpha * std::sqrt(1 - (2 * alpha - 1) * square) + 1 - alpha);
  const double root = z * z + (1 - xi * xi) * square;
  if (root < 0) return std::nullopt;
  return Vector3d((z * xi + std::sqrt(root)) / (z * z + square) * Vector3d(position.x(), position.y(), z) -
                  Vector3d(0, 0, xi));
}

std::optional<Vector3d> LensMapping::from_plane(const Vector2d& position) const {
  const double radius = position.norm();
  switch (lens_.model) {
    case LensModel::radial_tangential: {
      const auto found = brown_.undistort(position);
      return found ? std::optional(Vector3d(found->homogeneous())) : std::nullopt;
    }
    case LensModel::equidistant: {
      if (radius > equidistant_radius(widest_angle_)) return std::nullopt;
      if (radius == 0) return Vector3d(0, 0, 1);
      const double angle = equidistant_angle(radius);
      const Vector2d side = position * (std::sin(angle) / radius);
      return Vector3d(side.x(), side.y(), std::cos(angle));
    }
    case LensModel::field_of_view: {
      const double w = lens_.parameters[0];
      if (radius * w >= 0.5 * kPi) return std::nullopt;
      if (radius == 0) return Vector3d(0, 0, 1);
      const Vector2d side = position * (std::tan(radius * w) / (2 * std::tan(0.5 * w) * radius));
      return Vector3d(side.homogeneous());
    }
    case LensModel::double_sphere: return from_double_sphere(radius * radius, position);
    case LensModel::omnidirectional: {
      const auto found = brown_.undistort(position);
      if (!found) return std::nullopt;
      const double xi = lens_.parameters[0], square = found->squaredNorm(), root = 1 + (1 - xi * xi) * square;
      if (root < 0) return std::nullopt;
      const double length = (xi + std::sqrt(root)) / (1 + square);
      return Vector3d(length * found->x(), length * found->y(), length - xi);
    }
  }
  return std::nullopt;
}

std::optional<Vector2d> LensMapping::project(const Vector3d& ray) const {
  const auto position = to_plane(ray.normalized());
  if (!position) return std::nullopt;
  const PinholeCamera& camera = lens_.camera;
  return Vector2d(camera.fx * position->x() + camera.cx, camera.fy * position->y() + camera.cy);
}

std::optional<Vector3d> LensMapping::ray(const Vector2d& pixel) const {
  const auto found = from_plane(lens_.camera.ray(pixel).head<2>());
  return found ? std::optional(Vector3d(found->normalized())) : std::nullopt;
}

}  // namespace quadedge
