/// \file moving_cells.cpp  A binomial test per cell at the rate of the static ones; adjacent cells form groups.
#include "motion/moving_cells.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "motion/odometry_constants.hpp"

namespace quadedge::odometry {
namespace {

/// Fraction of the edges in cells that follow which agree closely.
double agreeing_rate(const std::vector<ExplainedCell>& cells) {
  double edges = 0, explained = 0;
  for (const ExplainedCell& cell : cells) {
    if (!(cell.edges > 0) || !cell.follows()) continue;
    edges += cell.edges;
    explained += cell.explained;
  }
  return edges > 0 ? explained / edges : 0;
}

/// Probability that at most `agreeing` of `edges` independent edges agree, each with the probability `rate`.
double probability_of_at_most(int agreeing, int edges, double rate) {
  if (rate >= 1) return agreeing < edges ? 0 : 1;
  double term = 1, sum = 0;
  for (int i = 0; i < edges; ++i) term *= 1 - rate;
  for (int i = 0; i <= agreeing; ++i) {
    sum += term;
    term *= (edges - i) * rate / ((i + 1) * (1 - rate));
  }
  return sum;
}

/// Marks the cells that move.
std::vector<std::uint8_t> moving(const std::vector<ExplainedCell>& cells) {
  const double rate = agreeing_rate(cells);
  std::vector<std::uint8_t> moves(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const ExplainedCell& cell = cells[i];
    if (!(cell.edges > 0) || cell.follows()) continue;
    const int agreeing = static_cast<int>(cell.explained), edges = static_cast<int>(cell.edges);
    moves[i] = probability_of_at_most(agreeing, edges, rate) < kChanceOfCell ? 1 : 0;
  }
  return moves;
}

/// Takes the group of adjacent cells around `seed` out of those that move. \returns its indices
std::vector<int> take_group(int seed, int columns, std::vector<std::uint8_t>& moves) {
  const int rows = static_cast<int>(moves.size()) / columns;
  std::vector<int> group{seed};
  moves[static_cast<std::size_t>(seed)] = 0;
  for (std::size_t next = 0; next < group.size(); ++next) {
    const int column = group[next] % columns, row = group[next] / columns;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows - 1); ++y)
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns - 1); ++x) {
        std::uint8_t& beside = moves[static_cast<std::size_t>(y * columns + x)];
        if (beside == 0) continue;
        beside = 0;
        group.push_back(y * columns + x);
      }
  }
  return group;
}

}  // namespace

MovingCells find_moving_cells(const ExplainedCells& cells) {
  MovingCells found;
  std::vector<std::uint8_t> moves = moving(cells.all());
  const int columns = cells.columns();
  Eigen::Array2d sum = Eigen::Array2d::Zero(), squares = Eigen::Array2d::Zero();
  std::vector<int> largest;
  for (int seed = 0; seed < static_cast<int>(moves.size()); ++seed) {
    if (moves[static_cast<std::size_t>(seed)] == 0) continue;
    std::vector<int> group = take_group(seed, columns, moves);
    for (const int cell : group) {
      const Eigen::Array2d position(cell % columns, cell / columns);
      sum += position;
      squares += position.square();
    }
    found.count += static_cast<int>(group.size());
    if (group.size() > largest.size()) largest.swap(group);
  }
  if (found.count == 0) return found;
  found.spread = std::sqrt((squares / found.count - (sum / found.count).square()).max(0).sum());
  for (const int cell : largest) {
    const Eigen::Vector2d corner(cell % columns, cell / columns);
    found.largest.extend(cells.side() * corner).extend(cells.side() * (corner + Eigen::Vector2d::Ones()));
  }
  return found;
}

}  // namespace quadedge::odometry
