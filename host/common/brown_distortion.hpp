#pragma once
/// \file brown_distortion.hpp  OpenCV's radial and tangential distortion on the plane at unit depth, with 0 to 14
/// coefficients: k1 k2 p1 p2, k3, k4 k5 k6 (rational), s1 to s4 (thin prism), tau_x tau_y (tilted sensor).

#include <Eigen/Core>
#include <array>
#include <optional>

namespace quadedge {

/// One set of coefficients.
class BrownDistortion {
 public:
  /// `coefficients`: the first `count` of the fourteen; the others are zero.
  BrownDistortion(const double* coefficients, std::size_t count);

  /// Distorted position of a point, regardless of radius_limit().
  Eigen::Vector2d distort(const Eigen::Vector2d& position) const;
  /// The point within radius_limit() whose distorted position is `position`, or nothing if there is none.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& position) const;
  /// Largest radius up to which the distorted radius increases; beyond it, the polynomial folds the image.
  double radius_limit() const { return limit_; }

 private:
  double radial(double square) const;
  bool grows(double square) const;
  double find_limit() const;
  Eigen::Vector2d start_of_search(const Eigen::Vector2d& position) const;

  std::array<double, 14> k_{};
  Eigen::Matrix3d tilt_, untilt_;
  double limit_;
};

}  // namespace quadedge
