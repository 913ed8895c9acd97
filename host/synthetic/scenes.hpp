#pragma once
/// \file scenes.hpp  The built-in scenes, in the frame of the left camera where the path "ellipse" starts.

#include <cstdint>
#include <string>

#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// The scene of this name, one of synthetic_scenes(). `focal` [px] only sets how finely the textures are sampled.
Scene make_scene(const std::string& name, std::uint64_t seed, double focal);

/// A room of about 6 x 3 x 8 m with boxes, boards, balls and pillars at 1.3 to 4 m; everything is richly textured.
Scene make_room(std::uint64_t seed, double focal);

/// Smoothly curved cables, 0.8 to 3 cm thick, at 1.4 to 2.7 m from the start, one before the other, before a nearly
/// plain wall.
Scene make_cables(std::uint64_t seed, double focal);

/// A street of houses with vertical siding and brick, windows in a grid, a picket fence and shrubs before them, seen at
/// a slant of 32 degrees from 2 m before the fence and 4.6 m before the fronts: textures and shapes that repeat.
Scene make_facade(std::uint64_t seed, double focal);

}  // namespace quadedge::synthetic
