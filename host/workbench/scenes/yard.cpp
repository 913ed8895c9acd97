/// \file yard.cpp  The scene "yard". Its frame: x right, y down, z along the walkway; the origin is the start of the
/// path "ellipse", at the height of a handheld camera.
#include <iterator>
#include <utility>
#include <vector>

#include "quadedge/camera.hpp"
#include "scenes/hash.hpp"
#include "scenes/reflectance.hpp"
#include "scenes/scenes.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Start of the path "ellipse".
Isometry3d world_from_yard() { return pose(Vector3d::Zero(), 0.03, 0.02, 0.01); }

class Yard {
 public:
  Yard(std::uint64_t seed, double focal)
      : build_(combine(seed, 12), focal, world_from_yard()), random_(combine(seed, 13)), focal_(focal) {}

  Scene finish() {
    ground();
    buildings();
    wall();
    posts();
    Scene scene = build_.finish(1.2, {world_from_yard() * at(-0.2, 0.0, -3.0), 26.0, 0.25});
    railing(scene);
    wires(scene);
    return scene;
  }

 private:
  static constexpr double kGround = 1.45, kBelow = 2.4;  // y [m] of the walkway, and of the meadow beyond the railing
  static constexpr double kWall = -2.4, kRail = 1.9, kPoles = 3.0, kFar = 17.0;  // x [m]
  static constexpr double kStart = -9.0, kEnd = 42.0;                            // z [m]
  static constexpr double kWallTop = -2.1, kArm = -4.3;                          // y [m]
  static constexpr double kHalf = 0.5 * (kEnd - kStart), kMiddle = 0.5 * (kStart + kEnd);
  static constexpr double kPostStep = 2.1, kBarStep = 0.15;          // of the railing [m]
  static constexpr double kPoleZ[] = {-8.0, 5.0, 17.0, 29.0, 41.0};  // z [m]
  static constexpr double kFacingUp = -0.5 * kPi;                    // pitch of a horizontal plane
  static constexpr double kNear = 1.2;  // [m], where a texel of what is near covers half a pixel

  static TextureStyle paint(double mean, double noise) {
    TextureStyle style;
    style.mean = mean, style.noise = noise, style.noise_size = 0.4;
    return style;
  }
  /// A walkway of concrete slabs, a meadow below it, and the sky.
  void ground() {
    CladdingStyle slabs;
    slabs.unit_width = 1.2, slabs.unit_height = 1.5, slabs.joint = 0.014, slabs.bond = 0.5;
    slabs.mean = 150.0, slabs.spread = 5.0, slabs.noise = 4.0, slabs.noise_size = 0.3;
    const double half = 0.5 * (kRail + 0.3 - kWall);
    build_.plane(pose({kWall + half, kGround, kMiddle}, 0.0, kFacingUp, 0.0), half, kHalf,
                 build_.clad(slabs, half, kHalf, kNear));
    TextureStyle meadow = leaves(0.25, 3, 0.0, 110.0);
    meadow.spread = 22.0;
    build_.plane(pose({30.0, kBelow, kMiddle}, 0.0, kFacingUp, 0.0), 29.0, 60.0,
                 build_.speckled(meadow, 29.0, 60.0, 3.0));
    TextureStyle sky;
    sky.noise = 8.0, sky.noise_size = 60.0, sky.mean = 215.0;
    build_.box(Isometry3d::Identity(), {120.0, 70.0, 120.0}, sky, 100.0, true);
  }

  /// Two plain buildings with a few windows: beyond the meadow, and at the end of the walkway.
  void buildings() {
    const auto building = [&](const Isometry3d& front, double half_width, double top, double tone) {
      const double height = 0.5 * (kBelow - top);
      build_.plane(front * at(0.0, kBelow - height, 0.0), half_width, height,
                   build_.speckled(paint(tone, 4.0), half_width, height, 8.0));
      const TexturePointer roof = build_.speckled(paint(85.0, 5.0), half_width, 0.2, 8.0);
      build_.front_sides(front * at(0.0, top, 0.0), {half_width + 0.3, 0.18, 0.4}, roof);
      const TexturePointer frame = build_.speckled(paint(225.0, 3.0), 0.8, 1.0, 8.0);
      const TexturePointer glass = build_.speckled(paint(70.0, 5.0), 0.8, 1.0, 8.0);
      for (double x = -half_width + 2.5; x < half_width - 2.0; x += 4.5) {
        for (double y = top + 2.2; y < kGround - 1.0; y += 3.0) {
          build_.front_sides(front * at(x, y, 0.0), {0.75, 0.95, 0.05}, frame);
          for (const double side : {-0.34, 0.34}) build_.plane(front * at(x + side, y, -0.06), 0.3, 0.85, glass);
        }
      }
    };
    building(pose({kFar, 0.0, kMiddle + 4.0}, 0.5 * kPi, 0.0, 0.0), 24.0, -4.6, 175.0);
    building(pose({-2.0, 0.0, kEnd}, 0.0, 0.0, 0.0), 14.0, -5.2, 195.0);
  }

  /// A plain wall with a coping, downpipes and a door.
  void wall() {
    const Isometry3d front = pose({kWall, 0.0, kMiddle}, -0.5 * kPi, 0.0, 0.0);  // x ahead, z into the wall
    const double height = 0.5 * (kGround - kWallTop);
    build_.plane(front * at(0.0, kGround - height, 0.0), kHalf, height,
                 build_.speckled(paint(190.0, 3.0), kHalf, height, kNear));
    build_.front_sides(front * at(0.0, kWallTop, 0.1), {kHalf, 0.05, 0.16},
                       build_.speckled(paint(120.0, 4.0), kHalf, 0.05, kNear));
    build_.front_sides(front * at(0.0, kGround - 0.08, 0.0), {kHalf, 0.08, 0.02},
                       build_.speckled(paint(110.0, 4.0), kHalf, 0.08, kNear));
    const TexturePointer door = build_.speckled(paint(80.0, 4.0), 0.5, 1.05, kNear);
    const TexturePointer frame = build_.speckled(paint(225.0, 3.0), 0.6, 1.1, kNear);
    for (const double z : {7.5, 22.0}) {
      build_.front_sides(front * at(z - kMiddle, kGround - 1.05, 0.0), {0.58, 1.12, 0.04}, frame);
      build_.plane(front * at(z - kMiddle, kGround - 1.03, -0.05), 0.5, 1.03, door);
    }
    for (double z = kStart + 3.0; z < kEnd; z += 5.0)
      build_.cylinder(at(kWall + 0.07, kGround - height, z), 0.045, height, paint(75.0, 4.0), kNear);
  }

  /// The poles of the wires, and the upright bars of the railing.
  void posts() {
    const double tall = 0.5 * (kBelow - kArm + 0.4);
    const TexturePointer arm = build_.speckled(paint(70.0, 6.0), 0.9, 0.06, 5.0);
    for (const double z : kPoleZ) {
      build_.cylinder(at(kPoles, kBelow - tall, z), 0.09, tall, paint(85.0, 8.0), 3.0);
      build_.front_sides(at(kPoles, kArm, z - 0.1), {0.9, 0.055, 0.05}, arm);
    }
    for (double z = kStart; z < kEnd; z += kPostStep)
      build_.cylinder(at(kRail, kGround - 0.55, z), 0.026, 0.55, paint(60.0, 4.0), kNear);
    for (double z = kStart; z < kEnd; z += kBarStep)
      build_.cylinder(at(kRail, kGround - 0.58, z), 0.009, 0.46, paint(60.0, 3.0), kNear);
  }

  /// A tube through points of the yard, beginning and ending near the first and the last.
  void tube(Scene& scene, const std::vector<Vector3d>& points, double radius, double reflectance) {
    std::vector<Vector3d> control;
    for (const Vector3d& point : points) control.push_back(world_from_yard() * point);
    control.insert(control.begin(), 2 * control[0] - control[1]);
    control.push_back(2 * control[control.size() - 1] - control[control.size() - 2]);
    scene.surfaces.push_back(tube_surface(control, radius, reflectance, 0.01 * kNear / focal_));
  }

  /// The rails.
  void railing(Scene& scene) {
    for (const auto& [above, radius] : {std::pair(1.1, 0.026), std::pair(0.12, 0.016)}) {
      std::vector<Vector3d> points;
      for (double z = kStart; z < kEnd; z += 3.0) points.emplace_back(kRail, kGround - above, z);
      tube(scene, points, radius, 60.0);
    }
  }

  /// A wire that hangs between two points.
  void wire(Scene& scene, const Vector3d& from, const Vector3d& to, double sag, double radius) {
    constexpr int kPieces = 10;
    std::vector<Vector3d> points;
    for (int i = 0; i <= kPieces; ++i) {
      const double t = static_cast<double>(i) / kPieces;
      points.emplace_back((1 - t) * from + t * to + Vector3d(0.0, 4 * sag * t * (1 - t), 0.0));
    }
    tube(scene, points, radius, 45.0);
  }

  /// Wires along the poles, across the walkway to the wall, and a cable along the wall.
  void wires(Scene& scene) {
    constexpr int kPoleCount = static_cast<int>(std::size(kPoleZ));
    for (int span = 0; span + 1 < kPoleCount; ++span) {
      const double from = kPoleZ[span], to = kPoleZ[span + 1];
      for (const double x : {-0.8, -0.3, 0.3, 0.8})
        wire(scene, {kPoles + x, kArm - 0.08, from}, {kPoles + x, kArm - 0.08, to}, random_(0.25, 0.45), 0.009);
      wire(scene, {kPoles - 0.1, -2.3, from}, {kPoles - 0.1, -2.3, to}, random_(0.3, 0.4), 0.014);
      const double before = random_(2.0, 4.0), behind = random_(1.0, 3.0);  // one after the other, in this order
      wire(scene, {kPoles, kArm + 0.3, to}, {kWall, kWallTop - 0.05, to - before}, random_(0.2, 0.5), 0.01);
      wire(scene, {kPoles, -2.6, to}, {kWall, kWallTop - 0.05, to + behind}, random_(0.2, 0.4), 0.011);
    }
    for (double z = kStart; z < kEnd - 5.0; z += 5.0)
      wire(scene, {kWall + 0.05, -0.95, z}, {kWall + 0.05, -0.95, z + 5.0}, random_(0.05, 0.3), 0.012);
  }

  SceneBuilder build_;
  Random random_;
  double focal_;
};

}  // namespace

Scene make_yard(std::uint64_t seed, double focal) { return Yard(seed, focal).finish(); }

}  // namespace quadedge::synthetic
