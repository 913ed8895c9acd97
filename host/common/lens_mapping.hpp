#pragma once
/// \file lens_mapping.hpp  Rays to pixels of a lens and back.

#include <Eigen/Core>
#include <optional>

#include "common/brown_distortion.hpp"
#include "quadedge/lens.hpp"

namespace quadedge {

/// Evaluates a lens. Rays are directions of any length in the camera's frame (x right, y down, z forward).
class LensMapping {
 public:
  explicit LensMapping(const Lens& lens);

  /// The pixel that shows what lies in a direction; nothing beyond the angle where the model ends or folds back. It may
  /// lie outside of the recorded image.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& ray) const;

  /// The direction (unit length) that a pixel shows; nothing where no ray of the model meets it.
  std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& pixel) const;

  /// Scale at the optical axis: the pinhole camera whose focal lengths are those of the model times this has it too.
  double axial_scale() const;

 private:
  std::optional<Eigen::Vector2d> to_plane(const Eigen::Vector3d& unit) const;
  std::optional<Eigen::Vector3d> from_plane(const Eigen::Vector2d& place) const;
  double equidistant_radius(double angle) const;
  double equidistant_angle(double radius) const;
  std::optional<Eigen::Vector3d> from_double_sphere(double square, const Eigen::Vector2d& place) const;

  Lens lens_;
  BrownDistortion brown_;    ///< radial_tangential, omnidirectional
  double widest_angle_ = 0;  ///< equidistant: from the optical axis [rad]
};

}  // namespace quadedge
