#pragma once
/// \file random_index.hpp  Uniform random indices that are identical on all platforms.

#include <cstddef>
#include <cstdint>
#include <random>

namespace quadedge::pose {

/// Uniform over 0 .. count - 1 (std::uniform_int_distribution differs between libraries).
inline std::size_t random_index(std::mt19937_64& random, std::size_t count) {
  return static_cast<std::size_t>(((random() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

}  // namespace quadedge::pose
