#pragma once
/// \file scene_builder.hpp  Builds scenes from solids.

#include <cstdint>
#include <memory>
#include <utility>

#include "synthetic/dead_leaves.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// Pose at `centre`, rotated about y, then x, then z of its own frame [rad].
Eigen::Isometry3d pose(const Eigen::Vector3d& centre, double yaw, double pitch, double roll);

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

  /// A texture for any number of surfaces, sampled for distances from `nearest` to 64 times that.
  std::shared_ptr<const Texture> shared_texture(std::unique_ptr<const Painter> painter, double half_width,
                                                double half_height, double nearest) const;
  /// The sides of a box that face -x, -y and -z (left, up and towards the viewer), with one texture.
  void front_sides(const Eigen::Isometry3d& room_from_box, const Eigen::Vector3d& half,
                   const std::shared_ptr<const Texture>& texture);
  void plane(const Eigen::Isometry3d& room_from_surface, double half_width, double half_height,
             std::shared_ptr<const Texture> texture, bool elliptic = false) {
    add<PlaneSurface>(room_from_surface, half_width, half_height, std::move(texture), elliptic);
  }

  /// Key of the next texture.
  std::uint64_t next_seed();

  /// Returns the scene. `nearest`: see Scene.
  Scene take(double nearest, const Lane& lane);

 private:
  std::shared_ptr<const Texture> texture(TextureStyle style, double half_width, double half_height, double nearest);
  template <typename Kind, typename... Arguments>
  void add(const Eigen::Isometry3d& room_from_surface, Arguments&&... arguments) {
    scene_.surfaces.push_back(
        std::make_unique<Kind>(world_from_room_ * room_from_surface, std::forward<Arguments>(arguments)...));
  }

  std::uint64_t seed_;
  double focal_;
  Eigen::Isometry3d world_from_room_;
  std::int64_t count_ = 0;
  Scene scene_;
};

}  // namespace quadedge::synthetic
