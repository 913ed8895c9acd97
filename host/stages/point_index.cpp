#include "stages/point_index.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::stages {

PointIndex make_point_index(const std::vector<float>& xs, const std::vector<float>& ys, int height) {
  const auto row_count = static_cast<std::size_t>(2 * height);
  std::vector<std::int32_t> row_of(ys.size());
  PointIndex index;
  index.row_first.assign(row_count + 1, 0);
  for (std::size_t i = 0; i < ys.size(); ++i) {
    row_of[i] = std::clamp(static_cast<std::int32_t>(std::lround(2.0f * ys[i])), 0, static_cast<std::int32_t>(row_count) - 1);
    ++index.row_first[static_cast<std::size_t>(row_of[i]) + 1];
  }
  for (std::size_t row = 0; row < row_count; ++row) index.row_first[row + 1] += index.row_first[row];
  std::vector<std::int32_t> next(index.row_first.begin(), index.row_first.end() - 1);
  index.order.resize(ys.size());
  for (std::size_t i = 0; i < ys.size(); ++i) {
    index.order[static_cast<std::size_t>(next[static_cast<std::size_t>(row_of[i])]++)] = static_cast<std::int32_t>(i);
  }
  for (std::size_t row = 0; row < row_count; ++row) {
    std::stable_sort(index.order.begin() + index.row_first[row], index.order.begin() + index.row_first[row + 1],
                     [&](std::int32_t a, std::int32_t b) { return xs[static_cast<std::size_t>(a)] < xs[static_cast<std::size_t>(b)]; });
  }
  return index;
}

}  // namespace quadedge::stages
