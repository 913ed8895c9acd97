#include <algorithm>
#include <cmath>

#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Vector3d;

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

TubeSurface::TubeSurface(const std::vector<Vector3d>& control, double radius, double reflectance, double tolerance)
    : radius_(radius), reflectance_(reflectance) {
  for (std::size_t i = 0; i + 3 < control.size(); ++i) {
    // A chord over dt deviates from the curve by at most |second derivative| dt^2 / 8; the second derivative is linear
    // in t.
    const double bend = std::max((control[i] - 2.0 * control[i + 1] + control[i + 2]).norm(),
                                 (control[i + 1] - 2.0 * control[i + 2] + control[i + 3]).norm());
    const int links = std::max(1, static_cast<int>(std::ceil(std::sqrt(bend / (8.0 * tolerance)))));
    for (int k = 0; k < links || (k == links && i + 4 == control.size()); ++k) {
      const auto [position, derivative] = spline(control, i, static_cast<double>(k) / links);
      points_.push_back(position);
      tangents_.push_back(derivative.normalized());
    }
  }
}

void TubeSurface::view(const Eigen::Isometry3d& camera_from_world, VisibleSurfaces& parts) const {
  const Vector3d light = camera_from_world.linear() * light_direction();
  for (std::size_t i = 0; i + 1 < points_.size(); ++i)
    parts.push_back(std::make_unique<VisibleLink>(
        camera_from_world * points_[i], camera_from_world * points_[i + 1], camera_from_world.linear() * tangents_[i],
        camera_from_world.linear() * tangents_[i + 1], radius_, reflectance_, light, this));
}

}  // namespace quadedge::synthetic
