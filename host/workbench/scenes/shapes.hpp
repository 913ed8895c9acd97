#pragma once
/// \file shapes.hpp  Surfaces of the synthetic scenes and their exact intersections with viewing rays.

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "quadedge/camera.hpp"
#include "scenes/texture.hpp"

namespace quadedge::synthetic {

/// Pixels [x0, x1) x [y0, y1) that a surface may cover.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Rays (x, y, 1) that are traced together.
struct RayBundle {
  Lanes x, y;

  Eigen::Vector3d operator[](std::size_t ray) const { return {x[ray], y[ray], 1.0}; }
};

/// A surface in a camera frame. Rays are normalised to (x, y, 1), so that a hit is at depth * ray.
class VisibleSurface {
 public:
  virtual ~VisibleSurface() = default;
  /// 1 / depth [1/m] of the first hit in front of the camera; 0 if the ray misses.
  virtual double inverse_depth(const Eigen::Vector3d& ray) const = 0;
  /// The same for all rays of a bundle, to the last bit.
  virtual void inverse_depths(const RayBundle& rays, Lanes& inverse) const {
    for (std::size_t i = 0; i < kLanes; ++i) inverse[i] = inverse_depth(rays[i]);
  }
  /// Radiance [grey levels] at a hit found by inverse_depth(). `spread`: distance between adjacent rays at unit depth.
  virtual double radiance(const Eigen::Vector3d& ray, double depth, double spread) const = 0;
  /// The same for all rays of a bundle, which hit the surface.
  virtual void radiances(const RayBundle& rays, const Lanes& inverse, double spread, Lanes& grey) const {
    for (std::size_t i = 0; i < kLanes; ++i) grey[i] = radiance(rays[i], 1.0 / inverse[i], spread);
  }
  /// Contains every pixel in which the surface is visible.
  virtual PixelBox pixels(const PinholeCamera& camera) const = 0;
  /// Identifies the object; equal for parts that join smoothly.
  virtual const void* object() const { return this; }
};
using VisibleSurfaces = std::vector<std::unique_ptr<VisibleSurface>>;

/// A surface in the world: appends it, or its parts, as seen by a camera. It must outlive them.
using Surface = std::function<void(const Eigen::Isometry3d& camera_from_world, VisibleSurfaces& parts)>;

/// A straight lane for a car, along z of its start.
struct Lane {
  Eigen::Isometry3d world_from_start = Eigen::Isometry3d::Identity();
  double length = 0.0;  ///< [m], free length
  double step = 0.0;    ///< typical speed [m per frame]
};

/// A scene with diffuse surfaces and one distant light.
struct Scene {
  std::vector<Surface> surfaces;
  Lane lane;
  double nearest = 0.0;  ///< no surface in view is closer to the camera along its path [m]
};

/// Direction towards the distant light of the scenes, world frame.
Eigen::Vector3d light_direction();
/// Fraction of the reflectance that a diffuse surface returns, from `ambient` (facing away) to 1 (facing the light),
/// with a smooth transition. Both directions have unit length and the same frame.
inline double shade(const Eigen::Vector3d& normal, const Eigen::Vector3d& light, double ambient) {
  return ambient + (1.0 - ambient) * (0.5 + 0.5 * normal.dot(light));
}
/// The pixels that overlap the bounding box of points in the camera frame; the whole image if a point is not in front
/// of the camera.
PixelBox box_around(const std::vector<Eigen::Vector3d>& points, const PinholeCamera& camera);

/// Pose at `centre`, rotated about y, then x, then z of its own frame [rad].
Eigen::Isometry3d pose(const Eigen::Vector3d& centre, double yaw, double pitch, double roll);

using TexturePointer = std::shared_ptr<const Texture>;

/// Rectangle or ellipse |u| <= half_width, |v| <= half_height in the plane z = 0 of `world_from_surface`, visible from
/// -z only (so that u points right and v down).
Surface plane_surface(const Eigen::Isometry3d& world_from_surface, double half_width, double half_height,
                      const TexturePointer& texture, bool elliptic = false);

/// Sphere; the texture is centred at the point that faces -z of `world_from_surface` (azimuthal equidistant).
Surface sphere_surface(const Eigen::Isometry3d& world_from_surface, double radius, const TexturePointer& texture);

/// Lateral surface of a cylinder around the y axis of `world_from_surface`, |y| <= half_height; the texture's seam
/// faces +z.
Surface cylinder_surface(const Eigen::Isometry3d& world_from_surface, double radius, double half_height,
                         const TexturePointer& texture);

/// Tube of constant radius around a uniform cubic B-spline of at least 4 control points in the world [m]. The curve is
/// divided into links short enough that the chain stays within `tolerance` [m] of it; normals are interpolated to avoid
/// facets.
Surface tube_surface(const std::vector<Eigen::Vector3d>& control, double radius, double reflectance, double tolerance);

}  // namespace quadedge::synthetic
