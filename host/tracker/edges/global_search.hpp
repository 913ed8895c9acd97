#pragma once
/// \file global_search.hpp  Extracts the stereo edges that take part in a global search.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::frontend {

/// The edges with these indices: positions and directions only; left_index holds the indices themselves.
inline StereoEdges edges_of(const StereoEdges& edges, const std::vector<std::int32_t>& numbers) {
  StereoEdges some;
  some.left_index = numbers;
  const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
    for (std::int32_t number : numbers) to.push_back(from[static_cast<std::size_t>(number)]);
  };
  copy(edges.left_x, some.left_x);
  copy(edges.left_y, some.left_y);
  copy(edges.left_direction, some.left_direction);
  copy(edges.right_x, some.right_x);
  copy(edges.right_y, some.right_y);
  copy(edges.right_direction, some.right_direction);
  return some;
}

/// Replaces indices into the result of edges_of() by the indices of the same edges in the full list.
inline void renumber(const std::vector<std::int32_t>& numbers, std::vector<std::int32_t>& indices) {
  for (auto& index : indices) index = numbers[static_cast<std::size_t>(index)];
}

}  // namespace quadedge::frontend
