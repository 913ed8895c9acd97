#pragma once
/// \file scenes.hpp  The two built-in scenes, in the frame of the first left camera.

#include <cstdint>

#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// A room of about 6 x 3 x 8 m with boxes, boards, balls and pillars at 1.3 to 4 m; everything is richly textured.
/// `focal` [px] only sets how finely the textures are sampled.
Scene make_room(std::uint64_t seed, double focal);

/// Smoothly curved cables, 0.8 to 3 cm thick, at 1.4 to 2.7 m from the start, one before the other, before a nearly
/// plain wall.
Scene make_cables(std::uint64_t seed, double focal);

}  // namespace quadedge::synthetic
