/// \file scenes.cpp  Places textured solids for "room" and "cables"; texels by the nearest distance.
#include "scenes/scenes.hpp"

#include <algorithm>
#include <vector>

#include "quadedge/camera.hpp"
#include "scenes/hash.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTexel = 0.5;  // [px] at the smallest distance of a surface
constexpr int kLevels = 7;      // of textures that are seen at small and large distances

/// One side of a box: its frame, whose -z axis faces outwards (or inwards), and its half sizes.
struct BoxSide {
  Isometry3d box_from_side;
  double half_width, half_height;
};
std::vector<BoxSide> box_sides(const Vector3d& half, bool inwards) {
  std::vector<BoxSide> sides;
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

/// A lane straight ahead.
Lane lane_ahead(double start, double length, double step) {
  return {Isometry3d(Eigen::Translation3d(0.0, 0.0, start)), length, step};
}

}  // namespace

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
  for (const BoxSide& side : box_sides(half, inwards))
    plane(room_from_box * side.box_from_side, side.half_width, side.half_height,
          texture(style, side.half_width, side.half_height, nearest));
}

void SceneBuilder::sphere(const Isometry3d& room_from_sphere, double radius, const TextureStyle& style,
                          double nearest) {
  scene_.surfaces.push_back(
      sphere_surface(world_from_room_ * room_from_sphere, radius, texture(style, kPi * radius, kPi * radius, nearest)));
}

void SceneBuilder::cylinder(const Isometry3d& room_from_cylinder, double radius, double half_height,
                            const TextureStyle& style, double nearest) {
  scene_.surfaces.push_back(cylinder_surface(world_from_room_ * room_from_cylinder, radius, half_height,
                                             texture(style, kPi * radius, half_height, nearest)));
  for (const double side : {-1.0, 1.0})
    plane(room_from_cylinder * pose(side * half_height * Vector3d::UnitY(), 0.0, side * 0.5 * kPi, 0.0), radius, radius,
          texture(style, radius, radius, nearest), true);
}

TexturePointer SceneBuilder::shared_texture(std::unique_ptr<const Painter> painter, double half_width,
                                            double half_height, double nearest) const {
  return std::make_shared<Texture>(std::move(painter), half_width, half_height, kTexel * nearest / focal_, kLevels);
}

TexturePointer SceneBuilder::speckled(const TextureStyle& style, double half_width, double half_height,
                                      double nearest) {
  return shared_texture(dead_leaves(style, next_seed()), half_width, half_height, nearest);
}

TexturePointer SceneBuilder::clad(const CladdingStyle& style, double half_width, double half_height, double nearest) {
  return shared_texture(cladding(style, next_seed()), half_width, half_height, nearest);
}

void SceneBuilder::plane(const Isometry3d& room_from_surface, double half_width, double half_height,
                         const TexturePointer& texture, bool elliptic) {
  scene_.surfaces.push_back(
      plane_surface(world_from_room_ * room_from_surface, half_width, half_height, texture, elliptic));
}

void SceneBuilder::front_sides(const Isometry3d& room_from_box, const Vector3d& half, const TexturePointer& texture) {
  for (const BoxSide& side : box_sides(half, false)) {
    const Vector3d outwards = -side.box_from_side.linear().col(2);
    if (outwards.sum() > 0.0) continue;
    plane(room_from_box * side.box_from_side, side.half_width, side.half_height, texture);
  }
}

std::uint64_t SceneBuilder::next_seed() { return combine(seed_, count_++); }

Scene SceneBuilder::finish(double nearest, const Lane& lane) {
  scene_.nearest = nearest;
  scene_.lane = lane;
  return std::move(scene_);
}

/// The tone varies slightly between faces.
TexturePointer SceneBuilder::texture(TextureStyle style, double half_width, double half_height, double nearest) {
  if (style.feature > 0.0) style.mean += 25.0 * (2.0 * uniform(combine(~seed_, count_)) - 1.0);
  return std::make_shared<Texture>(dead_leaves(style, next_seed()), half_width, half_height, kTexel * nearest / focal_);
}

SceneMakers& scene_makers() {
  static SceneMakers makers = {
      {"room", make_room}, {"cables", make_cables}, {"facade", make_facade}, {"yard", make_yard}};
  return makers;
}

Scene make_scene(const std::string& name, std::uint64_t seed, double focal) {
  return scene_makers().at(name)(seed, focal);
}

Scene make_room(std::uint64_t seed, double focal) {
  // Room: x right, y down, z into the scene; rotated so that no wall is parallel to the first image.
  SceneBuilder build(combine(seed, 1), focal, pose(Vector3d::Zero(), 0.2, 0.05, 0.03));
  TextureStyle walls = leaves(0.8, 4, 0.75, 150.0);
  walls.cover = 0.3;
  build.box(at(0.2, -0.15, 1.3), {3.0, 1.45, 4.0}, walls, 3.2, true);

  // Along the walls.
  build.box(pose({-2.0, 0.35, 3.5}, -0.25, 0.0, 0.0), {0.42, 0.95, 0.35}, leaves(0.4, 3, 1.0, 85.0), 2.3);
  build.box(pose({1.25, 0.8, 3.5}, 0.6, 0.0, 0.0), {0.42, 0.5, 0.42}, leaves(0.3, 3, 0.2, 190.0), 2.3);
  build.box(pose({1.2, 0.05, 3.55}, -0.3, 0.0, 0.0), {0.28, 0.25, 0.26}, leaves(0.25, 3, 0.0, 80.0), 2.3);
  build.cylinder(pose({-0.15, -0.15, 4.2}, 0.3, 0.0, 0.0), 0.17, 1.45, leaves(0.3, 3, 0.1, 200.0), 3.0);
  build.box(pose({-1.15, 1.0, 4.1}, 0.5, 0.0, 0.0), {0.3, 0.3, 0.3}, leaves(0.3, 3, 0.4, 70.0), 3.0);

  // A table with objects on it.
  build.box(pose({-0.55, 1.0, 2.5}, 0.35, 0.0, 0.0), {0.55, 0.3, 0.32}, leaves(0.24, 3, 0.5, 75.0), 1.6);
  build.cylinder(at(-0.82, 0.5, 2.45), 0.11, 0.2, leaves(0.14, 2, 0.0, 195.0), 1.6);
  build.sphere(at(-0.4, 0.53, 2.45), 0.17, leaves(0.14, 2, 0.0, 170.0), 1.5);
  build.box(pose({-0.55, 0.5, 2.75}, -0.5, 0.0, 0.0), {0.09, 0.2, 0.14}, leaves(0.14, 2, 0.6, 110.0), 1.8);

  // Boards and balls in the air, the nearest objects.
  build.box(pose({0.55, 0.25, 2.3}, 0.55, 0.2, 0.1), {0.25, 0.36, 0.02}, leaves(0.2, 3, 0.6, 90.0), 1.4);
  build.box(pose({-0.2, -0.55, 1.95}, -0.35, -0.25, -0.15), {0.24, 0.16, 0.02}, leaves(0.16, 3, 0.4, 190.0), 1.2);
  build.box(pose({-1.25, 0.05, 2.2}, -0.6, 0.15, 0.2), {0.2, 0.28, 0.02}, leaves(0.18, 3, 0.1, 175.0), 1.3);
  build.sphere(pose({-1.1, -0.75, 2.8}, 0.2, 0.1, 0.0), 0.21, leaves(0.18, 2, 0.0, 95.0), 1.8);
  build.sphere(at(0.75, -0.75, 2.7), 0.16, leaves(0.16, 2, 0.0, 75.0), 1.7);
  return build.finish(1.0, lane_ahead(-2.1, 2.8, 0.045));
}

Scene make_cables(std::uint64_t seed, double focal) {
  SceneBuilder build(combine(seed, 2), focal, pose(Vector3d::Zero(), 0.06, 0.03, 0.0));
  TextureStyle plain;
  plain.noise = 5.0;
  plain.noise_size = 0.8;
  plain.mean = 150.0;
  build.box(at(0.0, 0.0, 0.0), {9.0, 9.0, 3.1}, plain, 8.0, true);
  Scene scene = build.finish(0.9, lane_ahead(-2.6, 3.1, 0.05));

  // Every cable has its own layer of depth, so that cables cross without intersecting.
  Random random(combine(seed, 3));
  constexpr int kCables = 16, kControlPoints = 14;
  constexpr double kFront = 1.45, kBack = 2.65, kLayer = (kBack - kFront) / kCables;
  for (int cable = 0; cable < kCables; ++cable) {
    const double depth = kFront + (cable + 0.5) * kLayer;
    const double radius = 0.5 * random(0.008, 0.03);
    const double reflectance = cable % 2 == 0 ? random(40.0, 90.0) : random(180.0, 230.0);
    const bool across = random(0.0, 1.0) < 0.6;
    const double angle = across ? random(-0.4, 0.4) : 0.5 * kPi + random(-0.5, 0.5);
    const Vector3d along(std::cos(angle), std::sin(angle), 0.0), beside(-along.y(), along.x(), 0.0);
    const double offset = across ? random(-0.4, 0.4) * depth : random(-0.85, 0.85) * depth;
    std::vector<Vector3d> control;
    for (int i = 0; i < kControlPoints; ++i) {
      const double place = (i - 0.5 * (kControlPoints - 1)) * 0.45 + random(-0.1, 0.1);
      const double sway = offset + (i % 2 == 0 ? 1.0 : -1.0) * random(0.0, 0.3) + random(-0.15, 0.15);
      const double room = std::max(0.0, 0.5 * kLayer - radius);
      control.push_back(place * along + sway * beside + Vector3d(0.0, 0.0, depth + room * random(-1.0, 1.0)));
    }
    scene.surfaces.push_back(tube_surface(control, radius, reflectance, 0.01 * kFront / focal));
  }
  return scene;
}

}  // namespace quadedge::synthetic
