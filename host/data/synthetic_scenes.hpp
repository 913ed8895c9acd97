#pragma once
/// \file synthetic_scenes.hpp  The two built-in scenes, in the frame of the first left camera.

#include <cstdint>

#include "data/synthetic_shapes.hpp"

namespace quadedge::synthetic {

/// A room of about 6 x 3 x 8 m with boxes, boards, balls and pillars at 1.3 to 4 m; everything is richly textured.
/// `focal` [px] only sets how finely the textures are sampled.
Scene make_room(std::uint64_t seed, double focal);

/// Smoothly curved cables of 0.6 to 3 cm at 1.2 to 2.6 m, one before the other, before a nearly plain wall.
Scene make_cables(std::uint64_t seed, double focal);

}  // namespace quadedge::synthetic
