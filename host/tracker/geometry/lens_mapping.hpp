#pragma once
/// \file lens_mapping.hpp  Mapping between viewing rays and pixels of a lens.

#include <Eigen/Core>
#include <array>
#include <optional>

#include "quadedge/camera.hpp"

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

/// Evaluates a lens model. Rays are directions of any length in the camera frame (x right, y down, z forward).
class LensMapping {
 public:
  explicit LensMapping(const Lens& lens);

  /// Pixel for a viewing direction; nothing beyond the angle at which the model ends or folds. The pixel may lie
  /// outside the recorded image.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& ray) const;

  /// Viewing direction (unit length) of a pixel; nothing if no ray of the model maps to it.
  std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& pixel) const;

  /// Scale at the optical axis: a pinhole camera has the same scale if its focal lengths are those of the model times
  /// this.
  double axial_scale() const;

 private:
  std::optional<Eigen::Vector2d> to_plane(const Eigen::Vector3d& unit) const;
  std::optional<Eigen::Vector3d> from_plane(const Eigen::Vector2d& position) const;
  double equidistant_radius(double angle) const;
  double equidistant_angle(double radius) const;
  std::optional<Eigen::Vector3d> from_double_sphere(double square, const Eigen::Vector2d& position) const;

  Lens lens_;
  BrownDistortion brown_;    ///< for radial_tangential and omnidirectional
  double widest_angle_ = 0;  ///< for equidistant: limit of the angle from the optical axis [rad]
};

}  // namespace quadedge
