#pragma once
/// \file scenes.hpp  The built-in scenes, in the left camera frame at the start of the path "ellipse".

#include <cstdint>
#include <string>

#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// Scene with this name, one of synthetic_scenes(). `focal` [px] determines only the resolution of the textures.
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

/// A corridor of 4 x 2.6 x 48 m whose bays of 3 m have equal walls, doors and lamps; only the tiles of floor and
/// ceiling differ from bay to bay.
Scene make_corridor(std::uint64_t seed, double focal);

}  // namespace quadedge::synthetic
