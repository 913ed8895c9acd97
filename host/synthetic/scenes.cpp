#include "synthetic/scenes.hpp"

#include <algorithm>

#include "quadedge/camera.hpp"
#include "synthetic/hash.hpp"
#include "synthetic/scene_builder.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A lane straight ahead.
Lane lane_ahead(double start, double length, double step) {
  return {Isometry3d(Eigen::Translation3d(0.0, 0.0, start)), length, step};
}

}  // namespace

Scene make_scene(const std::string& name, std::uint64_t seed, double focal) {
  if (name == "room") return make_room(seed, focal);
  if (name == "cables") return make_cables(seed, focal);
  if (name == "corridor") return make_corridor(seed, focal);
  return make_facade(seed, focal);
}

Scene make_room(std::uint64_t seed, double focal) {
  // Room: x right, y down, z into the scene; rotated so that no wall is parallel to the first image.
  SceneBuilder build(combine(seed, 1), focal, pose(Vector3d::Zero(), 0.2, 0.05, 0.03));
  TextureStyle walls = leaves(0.8, 4, 0.75, 150.0);
  walls.cover = 0.3;
  build.box(pose({0.2, -0.15, 1.3}, 0.0, 0.0, 0.0), {3.0, 1.45, 4.0}, walls, 3.2, true);

  // Along the walls.
  build.box(pose({-2.0, 0.35, 3.5}, -0.25, 0.0, 0.0), {0.42, 0.95, 0.35}, leaves(0.4, 3, 1.0, 85.0), 2.3);
  build.box(pose({1.25, 0.8, 3.5}, 0.6, 0.0, 0.0), {0.42, 0.5, 0.42}, leaves(0.3, 3, 0.2, 190.0), 2.3);
  build.box(pose({1.2, 0.05, 3.55}, -0.3, 0.0, 0.0), {0.28, 0.25, 0.26}, leaves(0.25, 3, 0.0, 80.0), 2.3);
  build.cylinder(pose({-0.15, -0.15, 4.2}, 0.3, 0.0, 0.0), 0.17, 1.45, leaves(0.3, 3, 0.1, 200.0), 3.0);
  build.box(pose({-1.15, 1.0, 4.1}, 0.5, 0.0, 0.0), {0.3, 0.3, 0.3}, leaves(0.3, 3, 0.4, 70.0), 3.0);

  // A table with objects on it.
  build.box(pose({-0.55, 1.0, 2.5}, 0.35, 0.0, 0.0), {0.55, 0.3, 0.32}, leaves(0.24, 3, 0.5, 75.0), 1.6);
  build.cylinder(pose({-0.82, 0.5, 2.45}, 0.0, 0.0, 0.0), 0.11, 0.2, leaves(0.14, 2, 0.0, 195.0), 1.6);
  build.sphere(pose({-0.4, 0.53, 2.45}, 0.0, 0.0, 0.0), 0.17, leaves(0.14, 2, 0.0, 170.0), 1.5);
  build.box(pose({-0.55, 0.5, 2.75}, -0.5, 0.0, 0.0), {0.09, 0.2, 0.14}, leaves(0.14, 2, 0.6, 110.0), 1.8);

  // Boards and balls in the air, the nearest objects.
  build.box(pose({0.55, 0.25, 2.3}, 0.55, 0.2, 0.1), {0.25, 0.36, 0.02}, leaves(0.2, 3, 0.6, 90.0), 1.4);
  build.box(pose({-0.2, -0.55, 1.95}, -0.35, -0.25, -0.15), {0.24, 0.16, 0.02}, leaves(0.16, 3, 0.4, 190.0), 1.2);
  build.box(pose({-1.25, 0.05, 2.2}, -0.6, 0.15, 0.2), {0.2, 0.28, 0.02}, leaves(0.18, 3, 0.1, 175.0), 1.3);
  build.sphere(pose({-1.1, -0.75, 2.8}, 0.2, 0.1, 0.0), 0.21, leaves(0.18, 2, 0.0, 95.0), 1.8);
  build.sphere(pose({0.75, -0.75, 2.7}, 0.0, 0.0, 0.0), 0.16, leaves(0.16, 2, 0.0, 75.0), 1.7);
  return build.take(1.0, lane_ahead(-2.1, 2.8, 0.045));
}

Scene make_cables(std::uint64_t seed, double focal) {
  SceneBuilder build(combine(seed, 2), focal, pose(Vector3d::Zero(), 0.06, 0.03, 0.0));
  TextureStyle plain;
  plain.noise = 5.0;
  plain.noise_size = 0.8;
  plain.mean = 150.0;
  build.box(pose({0.0, 0.0, 0.0}, 0.0, 0.0, 0.0), {9.0, 9.0, 3.1}, plain, 8.0, true);
  Scene scene = build.take(0.9, lane_ahead(-2.6, 3.1, 0.05));

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
    scene.surfaces.push_back(std::make_unique<TubeSurface>(control, radius, reflectance, 0.01 * kFront / focal));
  }
  return scene;
}

}  // namespace quadedge::synthetic
