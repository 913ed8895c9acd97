/// \file shapes.cpp  Intersections in closed form; a cable is a spline cut into cylinders that balls join.
#include "scenes/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kNear = 0.01;     // [m], near clipping distance
constexpr double kAmbient = 0.72;  // for textured surfaces

/// Corners of the box |x| <= half in the frame of the camera.
std::vector<Vector3d> corners(const Isometry3d& camera_from_box, const Vector3d& half) {
  std::vector<Vector3d> result;
  for (int i = 0; i < 8; ++i)
    result.push_back(camera_from_box * Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).cwiseProduct(half));
  return result;
}

/// A plane in a camera frame: directions along it, and its normal divided by its distance.
struct PlaneNumbers {
  Vector3d u, v, inverse;
  double u_offset = 0, v_offset = 0, half_width = 0, half_height = 0;
};

/// Of a ray (x, y, 1), in one order for single rays and bundles.
inline double dot(const Vector3d& a, double x, double y) { return a.x() * x + a.y() * y + a.z(); }

QUADEDGE_VECTOR_CLONES
void hit_rectangle(const PlaneNumbers& plane, const RayBundle& rays, Lanes& inverse) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double x = rays.x[i], y = rays.y[i], hit = dot(plane.inverse, x, y);
    const double u = dot(plane.u, x, y) - plane.u_offset * hit, v = dot(plane.v, x, y) - plane.v_offset * hit;
    const bool inside =
        (hit > 0.0) & (std::abs(u) <= plane.half_width * hit) & (std::abs(v) <= plane.half_height * hit);
    inverse[i] = inside ? hit : 0.0;
  }
}

/// Positions on a plane that its texture is sampled at.
QUADEDGE_VECTOR_CLONES
void find_positions(const PlaneNumbers& plane, const RayBundle& rays, const Lanes& inverse, Lanes& u, Lanes& v) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double x = rays.x[i], y = rays.y[i], depth = 1.0 / inverse[i];
    u[i] = dot(plane.u, x, y) * depth - plane.u_offset;
    v[i] = dot(plane.v, x, y) * depth - plane.v_offset;
  }
}

class VisiblePlane : public VisibleSurface {
 public:
  VisiblePlane(const Isometry3d& camera_from_surface, double half_width, double half_height, const Texture& texture,
               bool elliptic, double shade)
      : shade_(shade), texture_(texture), elliptic_(elliptic) {
    const Eigen::Matrix3d axes = camera_from_surface.linear();
    const Vector3d centre = camera_from_surface.translation();
    const Vector3d u = axes.col(0), v = axes.col(1);
    plane_ = {u, v, axes.col(2) / axes.col(2).dot(centre), u.dot(centre), v.dot(centre), half_width, half_height};
    inverse_norm_ = plane_.inverse.norm();
    for (const auto& [across, down] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      outline_.push_back(camera_from_surface * Vector3d(across * half_width, down * half_height, 0.0));
  }

  double inverse_depth(const Vector3d& ray) const override {
    const double inverse = dot(plane_.inverse, ray.x(), ray.y());
    if (inverse <= 0.0) return 0.0;
    const double u = dot(plane_.u, ray.x(), ray.y()) - plane_.u_offset * inverse;  // both / depth
    const double v = dot(plane_.v, ray.x(), ray.y()) - plane_.v_offset * inverse;
    const double width = plane_.half_width * inverse, height = plane_.half_height * inverse;
    if (std::abs(u) > width || std::abs(v) > height) return 0.0;
    if (elliptic_ && u * u * height * height + v * v * width * width > width * width * height * height) return 0.0;
    return inverse;
  }
  void inverse_depths(const RayBundle& rays, Lanes& inverse) const override {
    if (elliptic_) return VisibleSurface::inverse_depths(rays, inverse);
    hit_rectangle(plane_, rays, inverse);
  }

  double radiance(const Vector3d& ray, double depth, double spread) const override {
    return shade_ * texture_.sample(dot(plane_.u, ray.x(), ray.y()) * depth - plane_.u_offset,
                                    dot(plane_.v, ray.x(), ray.y()) * depth - plane_.v_offset,
                                    footprint(ray, depth, spread));
  }
  void radiances(const RayBundle& rays, const Lanes& inverse, double spread, Lanes& grey) const override {
    Lanes u, v, footprints;
    find_positions(plane_, rays, inverse, u, v);
    for (std::size_t i = 0; i < kLanes; ++i) footprints[i] = footprint(rays[i], 1.0 / inverse[i], spread);
    texture_.sample(u, v, footprints, grey);
    for (double& value : grey) value *= shade_;
  }

  PixelBox pixels(const PinholeCamera& camera) const override {
    std::vector<Vector3d> clipped;
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Vector3d& a = outline_[i];
      const Vector3d& b = outline_[(i + 1) % outline_.size()];
      if (a.z() >= kNear) clipped.push_back(a);
      if ((a.z() >= kNear) != (b.z() >= kNear)) {
        Vector3d cut = a + (b - a) * ((kNear - a.z()) / (b.z() - a.z()));
        cut.z() = kNear;
        clipped.push_back(cut);
      }
    }
    return clipped.empty() ? PixelBox{} : box_around(clipped, camera);
  }

 private:
  /// On a slanted plane the hits of adjacent rays are farther apart: depth^2 |ray| / distance of the plane, times their
  /// spread.
  double footprint(const Vector3d& ray, double depth, double spread) const {
    return texture_.has_levels() ? spread * depth * depth * ray.norm() * inverse_norm_ : 0.0;
  }

  PlaneNumbers plane_;
  double inverse_norm_, shade_;
  const Texture& texture_;
  bool elliptic_;
  std::vector<Vector3d> outline_;
};

class VisibleSphere : public VisibleSurface {
 public:
  VisibleSphere(const Isometry3d& camera_from_surface, double radius, const Texture& texture, const Vector3d& light)
      : surface_from_camera_(camera_from_surface.inverse().linear()),
        camera_from_surface_(camera_from_surface),
        centre_(camera_from_surface.translation()),
        light_(light),
        radius_(radius),
        constant_(centre_.squaredNorm() - radius * radius),
        texture_(texture) {}

  double inverse_depth(const Vector3d& ray) const override {
    const double half_b = ray.dot(centre_), root = half_b * half_b - ray.squaredNorm() * constant_;
    if (root < 0.0 || half_b <= 0.0 || constant_ <= 0.0) return 0.0;
    return (half_b + std::sqrt(root)) / constant_;  // 1 / smaller root, without cancellation
  }

  double radiance(const Vector3d& ray, double depth, double spread) const override {
    const Vector3d normal = (depth * ray - centre_) / radius_, place = surface_from_camera_ * normal;
    const double side = std::hypot(place.x(), place.y());
    const double stretch = side > 1e-12 ? radius_ * std::atan2(side, -place.z()) / side : radius_;
    return shade(normal, light_, kAmbient) * texture_.sample(stretch * place.x(), stretch * place.y(), spread * depth);
  }

  PixelBox pixels(const PinholeCamera& camera) const override {
    return box_around(corners(camera_from_surface_, Vector3d::Constant(radius_)), camera);
  }

 private:
  Eigen::Matrix3d surface_from_camera_;
  Isometry3d camera_from_surface_;
  Vector3d centre_, light_;
  double radius_, constant_;
  const Texture& texture_;
};

class VisibleCylinder : public VisibleSurface {
 public:
  VisibleCylinder(const Isometry3d& camera_from_surface, double radius, double half_height, const Texture& texture,
                  const Vector3d& light)
      : surface_from_camera_(camera_from_surface.inverse()),
        camera_from_surface_(camera_from_surface),
        light_(surface_from_camera_.linear() * light),
        radius_(radius),
        half_height_(half_height),
        texture_(texture) {}

  double inverse_depth(const Vector3d& ray) const override {
    const Vector3d d = surface_from_camera_.linear() * ray;
    const Vector3d& o = surface_from_camera_.translation();
    const double a = d.x() * d.x() + d.z() * d.z(), half_b = -(d.x() * o.x() + d.z() * o.z());
    const double c = o.x() * o.x() + o.z() * o.z() - radius_ * radius_, root = half_b * half_b - a * c;
    if (root < 0.0 || half_b <= 0.0 || c <= 0.0) return 0.0;
    const double inverse = (half_b + std::sqrt(root)) / c;
    return std::abs(o.y() * inverse + d.y()) <= half_height_ * inverse ? inverse : 0.0;
  }

  double radiance(const Vector3d& ray, double depth, double spread) const override {
    const Vector3d place = surface_from_camera_ * (depth * ray);
    const double angle = std::atan2(place.x(), -place.z());
    const Vector3d normal = Vector3d(place.x(), 0.0, place.z()) / radius_;
    return shade(normal, light_, kAmbient) * texture_.sample(radius_ * angle, place.y(), spread * depth);
  }

  PixelBox pixels(const PinholeCamera& camera) const override {
    return box_around(corners(camera_from_surface_, {radius_, half_height_, radius_}), camera);
  }

 private:
  Isometry3d surface_from_camera_, camera_from_surface_;
  Vector3d light_;
  double radius_, half_height_;
  const Texture& texture_;
};

constexpr double kTubeAmbient = 0.3;  // low, so that the two sides of a cable differ clearly

/// Position and derivative of a uniform cubic B-spline in segment `i`, t in 0..1.
std::pair<Vector3d, Vector3d> spline(const std::vector<Vector3d>& c, std::size_t i, double t) {
  const double s = 1.0 - t;
  const Vector3d position = (s * s * s * c[i] + (3.0 * t * t * t - 6.0 * t * t + 4.0) * c[i + 1] +
                             (3.0 * s * s * s - 6.0 * s * s + 4.0) * c[i + 2] + t * t * t * c[i + 3]) /
                            6.0;
  const Vector3d derivative = 0.5 * (-s * s * c[i] + (3.0 * t * t - 4.0 * t) * c[i + 1] +
                                     (4.0 * s - 3.0 * s * s) * c[i + 2] + t * t * c[i + 3]);
  return {position, derivative};
}

/// A cylindrical link between two points, with a ball at its start that closes the joint to the previous link.
class VisibleLink : public VisibleSurface {
 public:
  VisibleLink(const Vector3d& start, const Vector3d& end, const Vector3d& start_tangent, const Vector3d& end_tangent,
              double radius, double reflectance, const Vector3d& light, const void* tube)
      : start_(start),
        axis_((end - start).normalized()),
        start_tangent_(start_tangent),
        end_tangent_(end_tangent),
        light_(light),
        length_((end - start).norm()),
        radius_(radius),
        reflectance_(reflectance),
        ball_(start.squaredNorm() - radius * radius),
        side_(ball_ - std::pow(start.dot(axis_), 2)),
        along_(start.dot(axis_)),
        tube_(tube) {}

  double inverse_depth(const Vector3d& ray) const override {
    const double squared = ray.squaredNorm(), toward = ray.dot(start_), slant = ray.dot(axis_);
    const double a = squared - slant * slant, half_b = toward - slant * along_, root = half_b * half_b - a * side_;
    if (root < 0.0) return 0.0;  // misses the infinite cylinder, and hence the ball inside it
    double nearest = 0.0;
    const double ball_root = toward * toward - squared * ball_;
    if (ball_root >= 0.0 && toward > 0.0 && ball_ > 0.0) nearest = (toward + std::sqrt(ball_root)) / ball_;
    if (half_b <= 0.0 || side_ <= 0.0) return nearest;
    const double inverse = (half_b + std::sqrt(root)) / side_;
    const double place = slant - along_ * inverse;  // along the axis, divided by depth
    return place >= 0.0 && place <= length_ * inverse ? std::max(inverse, nearest) : nearest;
  }

  double radiance(const Vector3d& ray, double depth, double /*spread*/) const override {
    const Vector3d hit = depth * ray - start_;
    const double along = std::clamp(hit.dot(axis_), 0.0, length_), fraction = along / length_;
    const Vector3d tangent = ((1.0 - fraction) * start_tangent_ + fraction * end_tangent_).normalized();
    Vector3d normal = hit - along * axis_;
    normal -= normal.dot(tangent) * tangent;
    return reflectance_ * shade(normal.normalized(), light_, kTubeAmbient);
  }

  PixelBox pixels(const PinholeCamera& camera) const override {
    std::vector<Vector3d> points;
    for (const Vector3d& end : {start_, Vector3d(start_ + length_ * axis_)})
      for (int i = 0; i < 8; ++i)
        points.push_back(end + radius_ * Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    if (std::all_of(points.begin(), points.end(), [](const Vector3d& p) { return p.z() <= 0.0; })) return {};
    return box_around(points, camera);
  }

  const void* object() const override { return tube_; }

 private:
  Vector3d start_, axis_, start_tangent_, end_tangent_, light_;
  double length_, radius_, reflectance_;
  double ball_, side_, along_;
  const void* tube_;
};

}  // namespace

Vector3d light_direction() { return Vector3d(-0.5, -0.75, -0.45).normalized(); }

PixelBox box_around(const std::vector<Vector3d>& points, const PinholeCamera& camera) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Vector3d& point : points) {
    if (point.z() < kNear) return {0, 0, camera.width, camera.height};
    const Eigen::Vector2d pixel = camera.project(point);
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const auto clip = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  constexpr double kFirst = 0.5 - 0.01,
                   kLast = 1.5 + 0.01;  // a pixel extends by half a pixel; 0.01 px for rounding
  return {clip(std::floor(low.x() + kFirst), camera.width), clip(std::floor(low.y() + kFirst), camera.height),
          clip(std::floor(high.x() + kLast), camera.width), clip(std::floor(high.y() + kLast), camera.height)};
}

Isometry3d pose(const Vector3d& centre, double yaw, double pitch, double roll) {
  Isometry3d result = Isometry3d::Identity();
  result.translation() = centre;
  result.linear() = (Eigen::AngleAxisd(yaw, Vector3d::UnitY()) * Eigen::AngleAxisd(pitch, Vector3d::UnitX()) *
                     Eigen::AngleAxisd(roll, Vector3d::UnitZ()))
                        .toRotationMatrix();
  return result;
}

Surface plane_surface(const Isometry3d& world_from_surface, double half_width, double half_height,
                      const TexturePointer& texture, bool elliptic) {
  return [=](const Isometry3d& camera_from_world, VisibleSurfaces& parts) {
    const Isometry3d camera_from_surface = camera_from_world * world_from_surface;
    if (camera_from_surface.linear().col(2).dot(camera_from_surface.translation()) < 1e-6) return;  // back face
    parts.push_back(
        std::make_unique<VisiblePlane>(camera_from_surface, half_width, half_height, *texture, elliptic,
                                       shade(-world_from_surface.linear().col(2), light_direction(), kAmbient)));
  };
}

Surface sphere_surface(const Isometry3d& world_from_surface, double radius, const TexturePointer& texture) {
  return [=](const Isometry3d& camera_from_world, VisibleSurfaces& parts) {
    parts.push_back(std::make_unique<VisibleSphere>(camera_from_world * world_from_surface, radius, *texture,
                                                    camera_from_world.linear() * light_direction()));
  };
}

Surface cylinder_surface(const Isometry3d& world_from_surface, double radius, double half_height,
                         const TexturePointer& texture) {
  return [=](const Isometry3d& camera_from_world, VisibleSurfaces& parts) {
    parts.push_back(std::make_unique<VisibleCylinder>(camera_from_world * world_from_surface, radius, half_height,
                                                      *texture, camera_from_world.linear() * light_direction()));
  };
}

Surface tube_surface(const std::vector<Vector3d>& control, double radius, double reflectance, double tolerance) {
  const auto curve = std::make_shared<std::vector<std::pair<Vector3d, Vector3d>>>();  // points and unit tangents
  for (std::size_t i = 0; i + 3 < control.size(); ++i) {
    // A chord over dt deviates from the curve by at most |second derivative| dt^2 / 8; the second derivative is linear
    // in t.
    const double bend = std::max((control[i] - 2.0 * control[i + 1] + control[i + 2]).norm(),
                                 (control[i + 1] - 2.0 * control[i + 2] + control[i + 3]).norm());
    const int links = std::max(1, static_cast<int>(std::ceil(std::sqrt(bend / (8.0 * tolerance)))));
    for (int k = 0; k < links || (k == links && i + 4 == control.size()); ++k) {
      const auto [position, derivative] = spline(control, i, static_cast<double>(k) / links);
      curve->emplace_back(position, derivative.normalized());
    }
  }
  return [=](const Isometry3d& camera_from_world, VisibleSurfaces& parts) {
    const Eigen::Matrix3d turn = camera_from_world.linear();
    for (std::size_t i = 0; i + 1 < curve->size(); ++i) {
      const auto& [start, start_tangent] = (*curve)[i];
      const auto& [end, end_tangent] = (*curve)[i + 1];
      parts.push_back(std::make_unique<VisibleLink>(camera_from_world * start, camera_from_world * end,
                                                    turn * start_tangent, turn * end_tangent, radius, reflectance,
                                                    turn * light_direction(), curve.get()));
    }
  };
}

}  // namespace quadedge::synthetic
