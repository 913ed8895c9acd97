#include "common/brown_distortion.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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

}  // namespace quadedge
