/// \file facade.cpp  The scene "facade". Its frame, "street": x along the house fronts, y down, z towards them; the
/// origin is the start of the path "ellipse", at the height of a handheld camera.
#include <algorithm>
#include <cmath>

#include "quadedge/camera.hpp"
#include "scenes/hash.hpp"
#include "scenes/reflectance.hpp"
#include "scenes/scenes.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSlant = 0.56;               // [rad], angle between the first view and the fronts
constexpr double kGround = 1.45;              // [m] below the camera
constexpr double kFence = 2.0, kFront = 4.6;  // z [m]
constexpr double kStart = -9.0, kEnd = 40.0;  // x [m]
constexpr double kEaves = -4.4;               // y [m]
constexpr double kFacingUp = -0.5 * kPi;      // pitch of a horizontal plane

/// Start of the path "ellipse".
Isometry3d street_from_world() { return pose(Vector3d::Zero(), kSlant, 0.02, 0.02); }

class Facade {
 public:
  Facade(std::uint64_t seed, double focal)
      : build_(combine(seed, 5), focal, street_from_world().inverse()), random_(combine(seed, 6)) {}

  Scene finish() {
    surroundings();
    houses();
    fence();
    shrubs();
    const Isometry3d street_from_lane = pose({-3.5, 0.0, -0.7}, 0.5 * kPi, 0.0, 0.0);  // along the fronts
    return build_.finish(0.85, {street_from_world().inverse() * street_from_lane, 26.0, 0.25});
  }

 private:
  /// Road, pavement, garden, the far side and the end of the road, and the sky.
  void surroundings() {
    constexpr double kMiddle = 0.5 * (kStart + kEnd), kHalf = 0.5 * (kEnd - kStart) + 12.0;
    const auto ground = [&](double from, double to, const TextureStyle& style, double drop) {
      const double half = 0.5 * (to - from);
      build_.plane(pose({kMiddle, kGround + drop, 0.5 * (from + to)}, 0.0, kFacingUp, 0.0), kHalf, half,
                   build_.speckled(style, kHalf, half, 1.7));
    };
    TextureStyle road = leaves(0.06, 3, 0.0, 105.0);
    road.spread = 35.0;
    ground(-30.0, 0.5, road, 0.1);
    CladdingStyle slabs;
    slabs.unit_width = 0.6, slabs.unit_height = 0.4, slabs.joint = 0.012, slabs.bond = 0.5;
    slabs.mean = 165.0, slabs.spread = 18.0, slabs.noise = 9.0;
    build_.plane(pose({kMiddle, kGround, 1.3}, 0.0, kFacingUp, 0.0), kHalf, 0.8, build_.clad(slabs, kHalf, 0.8, 1.7));
    TextureStyle lawn = leaves(0.09, 3, 0.0, 120.0);
    lawn.spread = 55.0;
    ground(2.1, kFront + 1.0, lawn, 0.0);

    TextureStyle hedge = leaves(0.16, 4, 0.0, 80.0);
    build_.plane(pose({kMiddle, 0.4, -5.0}, kPi, 0.0, 0.0), kHalf, 1.2, build_.speckled(hedge, kHalf, 1.2, 3.0));
    CladdingStyle far_boards = boards();
    far_boards.unit_width = 0.3;
    build_.plane(pose({kMiddle, -1.6, -9.0}, kPi, 0.0, 0.0), kHalf, 3.4, build_.clad(far_boards, kHalf, 3.4, 6.0));
    build_.plane(pose({kEnd + 6.0, -1.6, -2.0}, 0.5 * kPi, 0.0, 0.0), 12.0, 3.4, build_.clad(bricks(), 12.0, 3.4, 6.0));

    TextureStyle sky;
    sky.noise = 22.0, sky.noise_size = 30.0, sky.mean = 205.0;
    build_.box(Isometry3d::Identity(), {120.0, 70.0, 120.0}, sky, 100.0, true);
  }

  CladdingStyle boards() {
    CladdingStyle style;
    style.unit_width = random_(0.15, 0.2), style.unit_height = 2.9, style.joint = 0.014, style.bond = 0.0;
    style.mean = random_(180.0, 210.0), style.spread = 6.0, style.bevel = 7.0, style.joint_grey = 90.0;
    style.noise = 5.0, style.noise_size = 0.04, style.grain = 25.0;
    return style;
  }
  CladdingStyle bricks() {
    CladdingStyle style;
    style.unit_width = random_(0.22, 0.25), style.unit_height = 0.077, style.joint = 0.011, style.bond = 0.5;
    style.mean = random_(115.0, 145.0), style.spread = 18.0, style.joint_grey = random_(190.0, 210.0);
    style.noise = 7.0, style.noise_size = 0.05;
    return style;
  }

  /// A row of fronts, boards and bricks alternately; every second front is set back slightly.
  void houses() {
    bool boarded = random_(0.0, 1.0) < 0.5;
    double x = kStart;
    // The second border between fronts is in the middle of the first view.
    for (const double end : {-3.0 + random_(-0.6, 0.6), 2.9 + random_(-0.5, 0.5)}) {
      house(x, end, boarded);
      x = end;
      boarded = !boarded;
    }
    while (x < kEnd) {
      const double end = x + random_(5.5, 7.5);
      house(x, end, boarded);
      x = end;
      boarded = !boarded;
    }
  }

  void house(double from, double to, bool boarded) {
    const double half = 0.5 * (to - from), middle = 0.5 * (from + to), nearest = 3.2;
    const double front = kFront + (boarded ? 0.0 : random_(0.15, 0.3));
    const double half_height = 0.5 * (kGround - kEaves), centre = 0.5 * (kGround + kEaves);
    const TexturePointer wall = build_.clad(boarded ? boards() : bricks(), half, half_height, nearest);
    build_.front_sides(at(middle, centre, front + 1.5), {half, half_height, 1.5}, wall);
    TextureStyle stone = leaves(0.12, 3, 0.3, random_(110.0, 140.0));
    stone.spread = 30.0;
    build_.front_sides(at(middle, kGround - 0.2, front + 0.5), {half, 0.2, 0.54},
                       build_.speckled(stone, half, 0.54, nearest));
    TextureStyle paint = plain(random_(190.0, 225.0));
    build_.front_sides(at(middle, kEaves - 0.1, front + 0.5), {half, 0.12, 0.8},
                       build_.speckled(paint, half, 0.8, 5.0));
    CladdingStyle tiles;
    tiles.unit_width = 0.26, tiles.unit_height = 0.3, tiles.joint = 0.02, tiles.bond = 0.5;
    tiles.mean = random_(85.0, 110.0), tiles.spread = 14.0, tiles.joint_grey = 55.0;
    build_.plane(pose({middle, kEaves - 1.7, front + 1.9}, 0.0, -0.85, 0.0), half, 2.3,
                 build_.clad(tiles, half, 2.3, 6.0));
    windows(from, to, front, boarded);
  }

  static TextureStyle plain(double mean) {
    TextureStyle style;
    style.noise = 7.0, style.noise_size = 0.12, style.mean = mean;
    return style;
  }

  /// A grid of two rows of windows, with a door in place of one window of the lower row.
  void windows(double from, double to, double front, bool boarded) {
    const int columns = std::max(2, static_cast<int>((to - from) / 1.9));
    const double pitch = (to - from) / columns;
    const double half_width = random_(0.44, 0.54), half_height = random_(0.62, 0.74);
    const int bars = random_(0.0, 1.0) < 0.5 ? 1 : 2, door = static_cast<int>(random_(0.0, columns - 1e-9));
    const TexturePointer frame = build_.speckled(plain(random_(200.0, 230.0)), 0.8, 1.1, 3.2);
    TextureStyle glass = leaves(0.7, 2, 1.0, 70.0);
    glass.spread = 28.0, glass.noise = 6.0, glass.noise_size = 0.5;
    CladdingStyle slats;
    slats.unit_width = 1000.0, slats.unit_height = 0.055, slats.joint = 0.012, slats.bevel = 0.0;
    slats.mean = random_(70.0, 150.0), slats.spread = 4.0, slats.joint_grey = 45.0;
    TextureStyle wood = leaves(0.5, 2, 1.0, random_(85.0, 120.0));
    wood.spread = 22.0;
    const TexturePointer shutter = build_.clad(slats, 0.22, 0.8, 3.2);
    for (int column = 0; column < columns; ++column) {
      const double x = from + (column + 0.5) * pitch;
      for (const double y : {-0.25, -2.95}) {
        if (y > -1.0 && column == door) {
          opening({x, 0.35, front}, 0.47, 1.05, 0, frame, build_.speckled(wood, 0.47, 1.05, 3.2));
          continue;
        }
        opening({x, y, front}, half_width, half_height, bars, frame,
                build_.speckled(glass, half_width, half_height, 3.2));
        build_.front_sides(at(x, y + half_height + 0.08, front), {half_width + 0.12, 0.035, 0.13}, frame);
        if (!boarded) continue;
        for (const double side : {-1.0, 1.0})
          build_.front_sides(at(x + side * (half_width + 0.24), y, front), {0.17, half_height, 0.03}, shutter);
      }
    }
  }

  /// A pane with a frame and bars, in front of the wall.
  void opening(const Vector3d& centre, double half_width, double half_height, int bars, const TexturePointer& frame,
               const TexturePointer& pane) {
    constexpr double kFrame = 0.04, kProud = 0.05;
    const Isometry3d street_from_opening = pose(centre, 0.0, 0.0, 0.0);
    const auto beam = [&](double x, double y, double half_x, double half_y, double proud) {
      build_.front_sides(street_from_opening * at(x, y, 0.0), {half_x, half_y, proud}, frame);
    };
    build_.plane(street_from_opening * at(0.0, 0.0, -0.01), half_width, half_height, pane);
    for (const double side : {-1.0, 1.0}) {
      beam(side * half_width, 0.0, kFrame, half_height + kFrame, kProud);
      beam(0.0, side * half_height, half_width + kFrame, kFrame, kProud);
    }
    if (bars == 0) return;
    beam(0.0, 0.0, 0.018, half_height, 0.03);
    for (int bar = 1; bar <= bars; ++bar)
      beam(0.0, half_height * (2.0 * bar / (bars + 1) - 1.0), half_width, 0.018, 0.03);
  }

  void fence() {
    const double pitch = random_(0.13, 0.16), half_width = 0.3 * pitch, half_height = 0.52;
    std::vector<TexturePointer> paints;
    for (int i = 0; i < 6; ++i) {
      TextureStyle paint = plain(random_(205.0, 222.0));
      paint.noise = 9.0, paint.noise_size = 0.06;
      paints.push_back(build_.speckled(paint, half_width, half_height, 1.4));
    }
    const TexturePointer rail = build_.speckled(plain(195.0), 24.0, 0.05, 1.4);
    for (const double y : {kGround - 0.25, kGround - 0.85})
      build_.front_sides(at(0.5 * (kStart + kEnd), y, kFence + 0.03), {0.5 * (kEnd - kStart), 0.04, 0.018}, rail);
    const int count = static_cast<int>((kEnd - kStart) / pitch);
    for (int i = 0; i < count; ++i) {
      const bool post = i % 15 == 0;
      const double x = kStart + i * pitch, height = half_height + (post ? 0.08 : random_(-0.006, 0.006));
      const auto k = static_cast<std::size_t>(random_(0.0, static_cast<double>(paints.size()) - 1e-9));
      build_.front_sides(at(x, kGround - 0.04 - height, kFence), {post ? 0.05 : half_width, height, post ? 0.05 : 0.01},
                         paints[k]);
    }
  }

  /// Shrubs behind the fence, one in front of it, a tree, and a climber on the wall.
  void shrubs() {
    for (int i = 0; i < 8; ++i) {
      TextureStyle style = plain(random_(55.0, 150.0));
      style.noise = 14.0, style.noise_size = 0.05;
      leaf_.push_back(build_.speckled(style, 0.09, 0.09, 1.6));
    }
    for (double x = kStart + 3.0; x < kEnd; x += random_(2.0, 3.4)) {
      const double radius = random_(0.5, 0.8);
      const Vector3d half(radius, radius, 0.7 * radius);
      foliage({x, kGround - 0.85 * radius, random_(2.8, 3.6)}, half, 0.05, 420, true);
    }
    foliage({random_(2.3, 3.0), kGround - 0.3, 1.5}, {0.36, 0.36, 0.28}, 0.04, 320, true);
    const Vector3d tree(random_(5.2, 6.2), -1.9, 3.3);
    build_.cylinder(at(tree.x(), 0.2, tree.z()), 0.09, 1.3, leaves(0.08, 3, 0.2, 85.0), 4.0);
    foliage(tree, {1.1, 0.95, 0.75}, 0.065, 1100, true);
    foliage({random_(0.2, 1.0), -1.2, kFront - 0.02}, {0.35, 2.4, 0.12}, 0.07, 420, false);
  }

  /// Leaves on an ellipsoid with a dark interior.
  void foliage(const Vector3d& centre, const Vector3d& half, double leaf_size, int count, bool filled) {
    TextureStyle inside = leaves(0.1, 3, 0.0, 52.0);
    inside.spread = 25.0;
    if (filled) build_.sphere(at(centre.x(), centre.y(), centre.z()), 0.6 * half.minCoeff(), inside, 2.5);
    for (int i = 0; i < count; ++i) {
      // On the half that faces the street; leaves face approximately outwards.
      Vector3d outwards{random_(-1.0, 1.0), random_(-1.0, 1.0),
                        random_(-1.0, 0.25)};  // braces fix the order of evaluation
      outwards.normalize();
      const Vector3d place = centre + random_(filled ? 0.55 : 0.2, 1.0) * outwards.cwiseProduct(half);
      const Vector3d facing = (outwards + 0.7 * Vector3d{random_(-1.0, 0.4), random_(-1.0, 0.6), -0.6}).normalized();
      const double size = leaf_size * random_(0.7, 1.2);
      const auto k = static_cast<std::size_t>(random_(0.0, static_cast<double>(leaf_.size()) - 1e-9));
      build_.plane(pose(place, std::atan2(-facing.x(), -facing.z()), std::asin(std::clamp(facing.y(), -1.0, 1.0)),
                        random_(0.0, kPi)),
                   size, 0.5 * size, leaf_[k], true);
    }
  }

  SceneBuilder build_;
  Random random_;
  std::vector<TexturePointer> leaf_;
};

}  // namespace

Scene make_facade(std::uint64_t seed, double focal) { return Facade(seed, focal).finish(); }

}  // namespace quadedge::synthetic
