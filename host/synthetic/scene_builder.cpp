#include "synthetic/scene_builder.hpp"

#include <vector>

#include "quadedge/camera.hpp"
#include "synthetic/hash.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTexel = 0.5;  // [px] at the smallest distance of a surface
constexpr int kLevels = 7;      // of textures that are seen at small and large distances

/// One side of a box: its frame, whose -z axis faces outwards (or inwards), and its half sizes.
struct Side {
  Isometry3d box_from_side;
  double half_width, half_height;
};
std::vector<Side> box_sides(const Vector3d& half, bool inwards) {
  std::vector<Side> sides;
  const double sign = inwards ? -1.0 : 1.0;
  const auto add = [&](const Vector3d& outwards, double distance, double yaw, double pitch, double half_width,
                       double half_height) {
    sides.push_back({pose(sign * distance * outwards, yaw, pitch, 0.0), half_width, half_height});
  };
  add(-Vector3d::UnitZ(), half.z(), 0.0, 0.0, half.x(), half.y());
  add(Vector3d::UnitZ(), half.z(), kPi, 0.0, half.x(), half.y());
  add(-Vector3d::UnitX(), half.x(), 0.5 * kPi, 0.0, half.z(), half.y());
  add(Vector3d::UnitX(), half.x(), -0.5 * kPi, 0.0, half.z(), half.y());
  add(-Vector3d::UnitY(), half.y(), 0.0, -0.5 * kPi, half.x(), half.z());
  add(Vector3d::UnitY(), half.y(), 0.0, 0.5 * kPi, half.x(), half.z());
  return sides;
}

}  // namespace

Isometry3d pose(const Vector3d& centre, double yaw, double pitch, double roll) {
  Isometry3d result = Isometry3d::Identity();
  result.translation() = centre;
  result.linear() =
      (AngleAxisd(yaw, Vector3d::UnitY()) * AngleAxisd(pitch, Vector3d::UnitX()) * AngleAxisd(roll, Vector3d::UnitZ()))
          .toRotationMatrix();
  return result;
}

TextureStyle leaves(double feature, int levels, double alignment, double mean) {
  TextureStyle style;
  style.feature = feature;
  style.levels = levels;
  style.alignment = alignment;
  style.mean = mean;
  return style;
}

void SceneBuilder::box(const Isometry3d& room_from_box, const Vector3d& half, const TextureStyle& style, double nearest,
                       bool inwards) {
  for (const Side& side : box_sides(half, inwards))
    add<PlaneSurface>(room_from_box * side.box_from_side, side.half_width, side.half_height,
                      texture(style, side.half_width, side.half_height, nearest));
}

void SceneBuilder::sphere(const Isometry3d& room_from_sphere, double radius, const TextureStyle& style,
                          double nearest) {
  add<SphereSurface>(room_from_sphere, radius, texture(style, kPi * radius, kPi * radius, nearest));
}

void SceneBuilder::cylinder(const Isometry3d& room_from_cylinder, double radius, double half_height,
                            const TextureStyle& style, double nearest) {
  add<CylinderSurface>(room_from_cylinder, radius, half_height, texture(style, kPi * radius, half_height, nearest));
  for (const double side : {-1.0, 1.0})
    add<PlaneSurface>(room_from_cylinder * pose(side * half_height * Vector3d::UnitY(), 0.0, side * 0.5 * kPi, 0.0),
                      radius, radius, texture(style, radius, radius, nearest), true);
}

std::shared_ptr<const Texture> SceneBuilder::shared_texture(std::unique_ptr<const Painter> painter, double half_width,
                                                            double half_height, double nearest) const {
  return std::make_shared<Texture>(std::move(painter), half_width, half_height, kTexel * nearest / focal_, kLevels);
}

void SceneBuilder::front_sides(const Isometry3d& room_from_box, const Vector3d& half,
                               const std::shared_ptr<const Texture>& texture) {
  for (const Side& side : box_sides(half, false)) {
    const Vector3d outwards = -side.box_from_side.linear().col(2);
    if (outwards.sum() > 0.0) continue;
    plane(room_from_box * side.box_from_side, side.half_width, side.half_height, texture);
  }
}

std::uint64_t SceneBuilder::next_seed() { return combine(seed_, count_++); }

Scene SceneBuilder::take(double nearest, const Lane& lane) {
  scene_.nearest = nearest;
  scene_.lane = lane;
  return std::move(scene_);
}

/// The tone varies slightly between faces.
std::shared_ptr<const Texture> SceneBuilder::texture(TextureStyle style, double half_width, double half_height,
                                                     double nearest) {
  if (style.feature > 0.0) style.mean += 25.0 * (2.0 * uniform(combine(~seed_, count_)) - 1.0);
  return std::make_shared<Texture>(dead_leaves(style, next_seed()), half_width, half_height, kTexel * nearest / focal_);
}

}  // namespace quadedge::synthetic
