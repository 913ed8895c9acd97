#pragma once
/// \file scene_corridor.hpp  The scene "corridor" for the tests of places: bays with equal walls, doors and lamps.
#include "scenes/hash.hpp"
#include "scenes/reflectance.hpp"
#include "scenes/scenes.hpp"
#include "testing.hpp"

namespace quadedge::synthetic::corridor {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Its frame: x right, y down, z along the corridor; the origin is the start of the path "ellipse", at the height of a
// handheld camera. Only the tiles of floor and ceiling differ from bay to bay.
constexpr double kWall = 2.0;                    // x [m], of both walls
constexpr double kCeiling = -1.2, kFloor = 1.4;  // y [m]
constexpr double kFirstBay = -6.0, kBay = 3.0;   // z [m] of the first bay, length of a bay with a door
constexpr int kBays = 16;
constexpr double kTexelDistance = 0.9;  // [m], where a texel covers half a pixel

/// Start of the path "ellipse".
inline Isometry3d world_from_corridor() { return pose(Vector3d::Zero(), 0.08, 0.02, 0.01); }

inline TextureStyle paint(double mean, double noise) {
  TextureStyle style;
  style.mean = mean, style.noise = noise, style.noise_size = 0.12;
  return style;
}

class Corridor {
 public:
  Corridor(std::uint64_t seed, double focal)
      : build_(combine(seed, 10), focal, world_from_corridor()),
        wall_(speckled(paint(190.0, 6.0), 0.5 * kBay, 1.3)),
        skirting_(speckled(paint(95.0, 6.0), 0.5 * kBay, 0.06)),
        frame_(speckled(paint(120.0, 5.0), 0.6, 1.1)),
        door_(speckled(wood(), 0.5, 1.05)),
        plate_(speckled(leaves(0.03, 2, 1.0, 200.0), 0.09, 0.06)),
        lamp_(speckled(paint(230.0, 2.0), 0.6, 0.15)) {}

  Scene finish() {
    floor_and_ceiling();
    for (int bay = 0; bay < kBays; ++bay) {
      const double z = kFirstBay + (bay + 0.5) * kBay;
      for (const double side : {-1.0, 1.0}) bay_wall(pose({side * kWall, 0.0, z}, side * 0.5 * kPi, 0.0, 0.0));
      build_.plane(pose({0.0, kCeiling + 0.01, z}, 0.0, 0.5 * kPi, 0.0), 0.6, 0.15, lamp_);
    }
    return build_.finish(1.0, {world_from_corridor() * pose({0.0, 0.0, -1.0}, 0.0, 0.0, 0.0), 30.0, 0.25});
  }

 private:
  static TextureStyle wood() {
    TextureStyle style = leaves(0.35, 3, 1.0, 110.0);
    style.spread = 30.0;
    return style;
  }
  TexturePointer speckled(const TextureStyle& style, double half_width, double half_height) {
    return build_.speckled(style, half_width, half_height, kTexelDistance);
  }
  TexturePointer tiled(double side, double mean, double spread, double half_width, double half_height) {
    CladdingStyle style;
    style.unit_width = style.unit_height = side, style.joint = 0.008;
    style.mean = mean, style.spread = spread, style.joint_grey = 0.6 * mean, style.noise = 6.0;
    return build_.clad(style, half_width, half_height, kTexelDistance);
  }

  /// Tiles in tones of their own, which tell one part of the corridor from another; and the walls at its ends.
  void floor_and_ceiling() {
    const double half = 0.5 * kBays * kBay, middle = kFirstBay + half, height = 0.5 * (kFloor - kCeiling);
    build_.plane(pose({0.0, kFloor, middle}, 0.0, -0.5 * kPi, 0.0), kWall, half, tiled(0.31, 140.0, 14.0, kWall, half));
    build_.plane(pose({0.0, kCeiling, middle}, 0.0, 0.5 * kPi, 0.0), kWall, half, tiled(0.6, 205.0, 3.0, kWall, half));
    for (const double end : {-1.0, 1.0})
      build_.plane(pose({0.0, kFloor - height, middle + end * half}, end > 0 ? 0.0 : kPi, 0.0, 0.0), kWall, height,
                   speckled(leaves(0.4, 3, 0.8, 150.0), kWall, height));
  }

  /// A bay of a wall with its door, the same for all. \param corridor_from_wall x along the wall, z into it
  void bay_wall(const Isometry3d& corridor_from_wall) {
    const auto at = [&](double x, double y, double z) { return corridor_from_wall * pose({x, y, z}, 0.0, 0.0, 0.0); };
    const double height = 0.5 * (kFloor - kCeiling);
    build_.plane(at(0.0, kFloor - height, 0.0), 0.5 * kBay, height, wall_);
    build_.front_sides(at(0.0, kFloor - 0.06, 0.0), {0.5 * kBay, 0.06, 0.015}, skirting_);
    build_.plane(at(0.0, kFloor - 1.05, -0.02), 0.5, 1.05, door_);
    for (const double side : {-1.0, 1.0})
      build_.front_sides(at(side * 0.5, kFloor - 1.05, 0.0), {0.05, 1.1, 0.06}, frame_);
    build_.front_sides(at(0.0, kFloor - 2.1, 0.0), {0.55, 0.05, 0.06}, frame_);
    build_.front_sides(at(0.36, kFloor - 1.0, -0.05), {0.06, 0.012, 0.03}, skirting_);
    build_.plane(at(0.75, kFloor - 1.5, -0.01), 0.09, 0.06, plate_);
  }

  SceneBuilder build_;
  TexturePointer wall_, skirting_, frame_, door_, plate_, lamp_;
};

inline const bool kIsNew =
    scene_makers()
        .emplace("corridor", [](std::uint64_t seed, double focal) { return Corridor(seed, focal).finish(); })
        .second;

}  // namespace quadedge::synthetic::corridor
