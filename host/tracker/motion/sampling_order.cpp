/// \file sampling_order.cpp  Partial Fisher-Yates shuffles; a balanced subset takes quads in turn from all image cells.
#include "motion/sampling_order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace quadedge::pose {
namespace {

/// Sorts the quads by their square cell in the current left image: cells in row-major order without empty ones, quads
/// within a cell in their original order.
void sort_into_cells(const ScoringArrays& quads, double side, SubsetWorkspace& workspace) {
  const auto number = [&](float position) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(position) / side));
  };
  const auto [left, right] = std::minmax_element(quads.left_x.begin(), quads.left_x.end());
  const auto [top, bottom] = std::minmax_element(quads.left_y.begin(), quads.left_y.end());
  const std::int32_t first_column = number(*left), first_line = number(*top);
  const std::int32_t columns = number(*right) - first_column + 1, lines = number(*bottom) - first_line + 1;
  auto &cell_of = workspace.cell_of, &first = workspace.cell_first;
  cell_of.resize(quads.size());
  first.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines) + 1, 0);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    cell_of[i] = (number(quads.left_y[i]) - first_line) * columns + number(quads.left_x[i]) - first_column;
    ++first[static_cast<std::size_t>(cell_of[i]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  workspace.cells.clear();
  for (std::size_t c = 0; c + 1 < first.size(); ++c)
    if (first[c + 1] > first[c])
      workspace.cells.push_back(
          {static_cast<std::size_t>(first[c]), static_cast<std::size_t>(first[c + 1] - first[c])});
  workspace.members.resize(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i)
    workspace.members[static_cast<std::size_t>(first[static_cast<std::size_t>(cell_of[i])]++)] =
        static_cast<std::int32_t>(i);
}

}  // namespace

void random_subset(std::mt19937_64& random, std::size_t count, std::size_t size, std::vector<std::int32_t>& rows) {
  rows.resize(count);
  std::iota(rows.begin(), rows.end(), 0);
  size = std::min(size, count);
  for (std::size_t i = 0; i < size; ++i) std::swap(rows[i], rows[i + random_index(random, count - i)]);
  rows.resize(size);
}

void balanced_subset(std::mt19937_64& random, const ScoringArrays& quads, double side, std::size_t size,
                     SubsetWorkspace& workspace, std::vector<std::int32_t>& rows) {
  rows.clear();
  if (quads.size() == 0) return;
  sort_into_cells(quads, side, workspace);
  auto& cells = workspace.cells;
  auto& held = workspace.cell_sizes;
  for (std::size_t i = 0; i < cells.size(); ++i) std::swap(cells[i], cells[i + random_index(random, cells.size() - i)]);
  held.clear();
  for (const auto& cell : cells) held.push_back(cell.size);
  const auto median = held.begin() + static_cast<std::ptrdiff_t>(held.size() / 2);
  std::nth_element(held.begin(), median, held.end());
  for (std::size_t round = 0; round < *median && rows.size() < size; ++round) {
    for (const auto& cell : cells) {
      if (cell.size <= round || rows.size() == size) continue;
      std::int32_t* const first = workspace.members.data() + cell.begin;
      std::swap(first[round], first[round + random_index(random, cell.size - round)]);
      rows.push_back(first[round]);
    }
  }
}

}  // namespace quadedge::pose
