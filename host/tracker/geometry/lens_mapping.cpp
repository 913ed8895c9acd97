/// \file lens_mapping.cpp  Projection in closed form; inverted by Newton's method (Brown) or bisection (equidistant).
#include "geometry/lens_mapping.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "quadedge/camera.hpp"

namespace quadedge {
namespace {

constexpr double kWidestRadius = 60;  // tangent of 89 degrees

/// Projection from a sensor that is rotated about x, then y, to the plane orthogonal to the optical axis.
Eigen::Matrix3d tilt_of(double tau_x, double tau_y) {
  Eigen::Matrix3d about_x, about_y, onto_sensor;
  about_x << 1, 0, 0, 0, std::cos(tau_x), std::sin(tau_x), 0, -std::sin(tau_x), std::cos(tau_x);
  about_y << std::cos(tau_y), 0, -std::sin(tau_y), 0, 1, 0, std::sin(tau_y), 0, std::cos(tau_y);
  const Eigen::Matrix3d rotation = about_y * about_x;
  onto_sensor << rotation(2, 2), 0, -rotation(0, 2), 0, rotation(2, 2), -rotation(1, 2), 0, 0, 1;
  return onto_sensor * rotation;
}

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

BrownDistortion::BrownDistortion(const double* coefficients, std::size_t count) {
  std::copy_n(coefficients, std::min(count, k_.size()), k_.begin());
  tilt_ = tilt_of(k_[12], k_[13]);
  untilt_ = tilt_.inverse();
  limit_ = find_limit();
}

double BrownDistortion::radial(double square) const {
  return (1 + square * (k_[0] + square * (k_[1] + square * k_[4]))) /
         (1 + square * (k_[5] + square * (k_[6] + square * k_[7])));
}

/// Whether the distorted radius increases at the radius with this square. For r N(s) / D(s) with s = r^2, the
/// derivative has the sign of N D + 2 s (N' D - N D').
bool BrownDistortion::grows(double square) const {
  const double above = 1 + square * (k_[0] + square * (k_[1] + square * k_[4]));
  const double below = 1 + square * (k_[5] + square * (k_[6] + square * k_[7]));
  const double above_slope = k_[0] + square * (2 * k_[1] + square * 3 * k_[4]);
  const double below_slope = k_[5] + square * (2 * k_[6] + square * 3 * k_[7]);
  return below > 0 && above * below + 2 * square * (above_slope * below - above * below_slope) > 0;
}

double BrownDistortion::find_limit() const {
  constexpr double kStep = 0.01;
  for (double radius = kStep; radius < kWidestRadius; radius += kStep) {
    if (grows(radius * radius)) continue;
    double inside = radius - kStep, outside = radius;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (inside + outside);
      (grows(middle * middle) ? inside : outside) = middle;
    }
    return inside;
  }
  return kWidestRadius;
}

Eigen::Vector2d BrownDistortion::distort(const Eigen::Vector2d& position) const {
  const double x = position.x(), y = position.y(), square = position.squaredNorm(), scale = radial(square);
  const double cross = 2 * x * y, along_x = square + 2 * x * x, along_y = square + 2 * y * y;
  const double prism_x = square * (k_[8] + square * k_[9]), prism_y = square * (k_[10] + square * k_[11]);
  const Eigen::Vector2d flat(x * scale + k_[2] * cross + k_[3] * along_x + prism_x,
                             y * scale + k_[2] * along_y + k_[3] * cross + prism_y);
  return k_[12] == 0 && k_[13] == 0 ? flat : Eigen::Vector2d((tilt_ * flat.homogeneous()).hnormalized());
}

/// Solution for the radial part alone, by bisection, because the radius increases up to the limit.
Eigen::Vector2d BrownDistortion::start_of_search(const Eigen::Vector2d& position) const {
  const double target = position.norm();
  if (target == 0) return position;
  double low = 0, high = limit_;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * radial(middle * middle) < target ? low : high) = middle;
  }
  return position * (low / target);
}

std::optional<Eigen::Vector2d> BrownDistortion::undistort(const Eigen::Vector2d& seen) const {
  const Eigen::Vector2d position =
      k_[12] == 0 && k_[13] == 0 ? seen : Eigen::Vector2d((untilt_ * seen.homogeneous()).hnormalized());
  Eigen::Vector2d found = start_of_search(position);
  constexpr int kSteps = 20;
  constexpr double kDifference = 1e-6, kSettled = 1e-15, kWrong = 1e-11;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix2d slope;  // by finite differences, accurate to 1e-9
    slope << (distort(found + Eigen::Vector2d(kDifference, 0)) - distort(found - Eigen::Vector2d(kDifference, 0))),
        (distort(found + Eigen::Vector2d(0, kDifference)) - distort(found - Eigen::Vector2d(0, kDifference)));
    const Eigen::Vector2d move = (slope / (2 * kDifference)).inverse() * (seen - distort(found));
    if (!move.allFinite()) return std::nullopt;
    found += move;
    if (move.norm() <= kSettled * (1 + found.norm())) break;
  }
  if (!((distort(found) - seen).norm() <= kWrong * (1 + seen.norm())) || found.norm() > limit_) return std::nullopt;
  return found;
}

const char* to_string(LensModel model) {
  switch (model) {
    case LensModel::radial_tangential: return "radtan";
    case LensModel::equidistant: return "equidistant";
    case LensModel::field_of_view: return "fov";
    case LensModel::double_sphere: return "double-sphere";
    case LensModel::extended_unified: return "eucm";
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
    case LensModel::equidistant:
    case LensModel::extended_unified: return 1;
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
    case LensModel::extended_unified: {
      const double alpha = k[0], far = std::sqrt(k[1] * side * side + z * z);
      const double w = alpha <= 0.5 ? alpha / (1 - alpha) : (1 - alpha) / alpha;
      if (z <= -w * far) return std::nullopt;
      return Vector2d(unit.head<2>() / (alpha * far + (1 - alpha) * z));
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
    case LensModel::extended_unified: {
      const double alpha = lens_.parameters[0], square = lens_.parameters[1] * radius * radius;
      const double under_root = 1 - (2 * alpha - 1) * square;
      if (under_root < 0) return std::nullopt;
      const double z = (1 - alpha * alpha * square) / (alpha * std::sqrt(under_root) + 1 - alpha);
      return Vector3d(position.x(), position.y(), z);
    }
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
