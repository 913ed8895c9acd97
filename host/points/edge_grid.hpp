#pragma once
/// \file edge_grid.hpp  Edges of an image, sorted into cells.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace quadedge::points {

/// Finds the edges near a position. The side of a cell is 2 px, the search radius around an edge.
class EdgeGrid {
 public:
  /// Sorts edges by cell, then by index. Positions in pixels.
  void fill(const std::vector<float>& x, const std::vector<float>& y, int width, int height) {
    columns_ = width / kCell + 1;
    rows_ = height / kCell + 1;
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (std::size_t i = 0; i < x.size(); ++i) ++first_[cell(column(x[i]), row(y[i])) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    edges_.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) edges_[next[cell(column(x[i]), row(y[i]))]++] = i;
  }

  /// Calls visit(index) for every edge within 2 px along both axes, and for some farther away.
  template <class Visit>
  void for_each_near(double x, double y, const Visit& visit) const {
    for (int r = std::max(row(y) - 1, 0); r <= std::min(row(y) + 1, rows_ - 1); ++r) {
      for (int c = std::max(column(x) - 1, 0); c <= std::min(column(x) + 1, columns_ - 1); ++c) {
        for (std::size_t i = first_[cell(c, r)]; i < first_[cell(c, r) + 1]; ++i) visit(edges_[i]);
      }
    }
  }

 private:
  static constexpr int kCell = 2;  // px
  int column(double x) const { return std::clamp(static_cast<int>(x) / kCell, 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>(y) / kCell, 0, rows_ - 1); }
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  int columns_ = 0, rows_ = 0;
  std::vector<std::size_t> first_;  ///< edges of cell c: first_[c] .. first_[c + 1] - 1
  std::vector<std::size_t> edges_;
};

}  // namespace quadedge::points
