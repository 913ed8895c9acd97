#pragma once
/// \file point_index.hpp  Points sorted by cells of the image, so that the cost of a search is proportional to the
/// number of points found.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/layouts.hpp"

namespace quadedge::reference {

/// Points sorted by cell, cells in rows, and within a cell by number.
struct PointIndex {
  int columns = 0, rows = 0;             ///< cells
  std::vector<std::int32_t> cell_first;  ///< columns * rows + 1
  std::vector<std::int32_t> order;       ///< numbers of the points in that order

  int column(float x) const {
    return static_cast<int>(std::clamp(x / kCellWidth, 0.0f, static_cast<float>(columns - 1)));
  }
  int row(float y) const { return static_cast<int>(std::clamp(y / kCellHeight, 0.0f, static_cast<float>(rows - 1))); }

  /// Calls `visit(number)` for every point in the cells that a square of half side `radius` around (x, y) touches, in
  /// their order.
  template <class Visit>
  void visit_square(float x, float y, float radius, const Visit& visit) const {
    const int first_column = column(x - radius), last_column = column(x + radius), last_row = row(y + radius);
    for (int r = row(y - radius); r <= last_row; ++r) {
      const auto begin = cell_first[static_cast<std::size_t>(r * columns + first_column)];
      const auto end = cell_first[static_cast<std::size_t>(r * columns + last_column + 1)];
      for (auto k = begin; k < end; ++k) visit(order[static_cast<std::size_t>(k)]);
    }
  }
};

/// Index of points in an image of width x height px; points outside it count to the nearest cell. `index` keeps its
/// memory.
void make_point_index(const std::vector<float>& xs, const std::vector<float>& ys, int width, int height,
                      PointIndex& index);

}  // namespace quadedge::reference
