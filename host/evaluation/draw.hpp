#pragma once
/// \file draw.hpp  Random indices that are identical for every standard library.

#include <cstddef>
#include <random>

namespace quadedge::evaluation {

/// Uniform in 0 .. size - 1.
inline std::size_t draw(std::mt19937_64& random, std::size_t size) {
  return static_cast<std::size_t>(static_cast<double>(random() >> 11) * 0x1p-53 * static_cast<double>(size));
}

}  // namespace quadedge::evaluation
