#include "reference/point_index.hpp"

namespace quadedge::reference {

void make_point_index(const std::vector<float>& xs, const std::vector<float>& ys, int width, int height,
                      PointIndex& index) {
  index.columns = static_cast<int>((static_cast<float>(width) + kCellWidth - 1) / kCellWidth);
  index.rows = static_cast<int>((static_cast<float>(height) + kCellHeight - 1) / kCellHeight);
  const auto cell = [&](std::size_t i) {
    return static_cast<std::size_t>(index.row(ys[i]) * index.columns + index.column(xs[i]));
  };
  const auto cells = static_cast<std::size_t>(index.columns * index.rows);
  // Two positions ahead, so that filling moves every start to where the cell's own entry has to be.
  auto& first = index.cell_first;
  first.assign(cells + 2, 0);
  for (std::size_t i = 0; i < xs.size(); ++i) ++first[cell(i) + 2];
  for (std::size_t c = 2; c < first.size(); ++c) first[c] += first[c - 1];
  index.order.resize(xs.size());
  for (std::size_t i = 0; i < xs.size(); ++i)
    index.order[static_cast<std::size_t>(first[cell(i) + 1]++)] = static_cast<std::int32_t>(i);
  first.pop_back();
}

}  // namespace quadedge::reference
