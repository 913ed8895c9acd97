#pragma once
/// \file scenes.hpp  The built-in scenes, in the left camera frame at the start of the path "ellipse", and what
/// builds them.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "scenes/reflectance.hpp"
#include "scenes/shapes.hpp"

namespace quadedge::synthetic {

// Builds scenes from solids.

/// Pose at a place, with the axes of its frame.
inline Eigen::Isometry3d at(double x, double y, double z) { return pose({x, y, z}, 0.0, 0.0, 0.0); }

/// Dead leaves with the default noise.
TextureStyle leaves(double feature, int levels, double alignment, double mean);

/// Assembles solids in the frame "room"; every face gets its own texture.
class SceneBuilder {
 public:
  SceneBuilder(std::uint64_t seed, double focal, const Eigen::Isometry3d& world_from_room)
      : seed_(seed), focal_(focal), world_from_room_(world_from_room) {}

  /// `nearest`: distance [m] at which a texel covers half a pixel.
  void box(const Eigen::Isometry3d& room_from_box, const Eigen::Vector3d& half, const TextureStyle& style,
           double nearest, bool inwards = false);
  void sphere(const Eigen::Isometry3d& room_from_sphere, double radius, const TextureStyle& style, double nearest);
  void cylinder(const Eigen::Isometry3d& room_from_cylinder, double radius, double half_height,
                const TextureStyle& style, double nearest);

  // Textures for any number of surfaces, sampled for distances from `nearest` to 64 times that.
  TexturePointer speckled(const TextureStyle& style, double half_width, double half_height, double nearest);
  TexturePointer clad(const CladdingStyle& style, double half_width, double half_height, double nearest);
  /// The sides of a box that face -x, -y and -z (left, up and towards the viewer), with one texture.
  void front_sides(const Eigen::Isometry3d& room_from_box, const Eigen::Vector3d& half, const TexturePointer& texture);
  void plane(const Eigen::Isometry3d& room_from_surface, double half_width, double half_height,
             const TexturePointer& texture, bool elliptic = false);

  /// Returns the scene. `nearest`: see Scene.
  Scene finish(double nearest, const Lane& lane);

 private:
  TexturePointer texture(TextureStyle style, double half_width, double half_height, double nearest);
  TexturePointer shared_texture(std::unique_ptr<const Painter> painter, double half_width, double half_height,
                                double nearest) const;
  /// Key of the next texture.
  std::uint64_t next_seed();

  std::uint64_t seed_;
  double focal_;
  Eigen::Isometry3d world_from_room_;
  std::int64_t count_ = 0;
  Scene scene_;
};

/// What makes the scenes, by name; tests add their own. `focal` [px] determines only the resolution of the textures.
using SceneMakers = std::map<std::string, std::function<Scene(std::uint64_t seed, double focal)>>;
SceneMakers& scene_makers();

/// Scene with this name, one of scene_makers().
Scene make_scene(const std::string& name, std::uint64_t seed, double focal);

/// A room of about 6 x 3 x 8 m with boxes, boards, balls and pillars at 1.3 to 4 m, all richly textured.
Scene make_room(std::uint64_t seed, double focal);

/// Smoothly curved cables, 0.8 to 3 cm thick, at 1.4 to 2.7 m from the start, one in front of the other, in front of a
/// nearly plain wall.
Scene make_cables(std::uint64_t seed, double focal);

/// A street of houses with vertical siding and brick, a grid of windows, and a picket fence and shrubs in front, seen
/// at an angle of 32 degrees from 2 m in front of the fence and 4.6 m in front of the houses: repetitive textures and
/// shapes.
Scene make_facade(std::uint64_t seed, double focal);

/// A walkway between a plain wall and a railing, with wires above it on poles and across to the wall: thin structures
/// and outlines, hardly any corners.
Scene make_yard(std::uint64_t seed, double focal);

}  // namespace quadedge::synthetic
