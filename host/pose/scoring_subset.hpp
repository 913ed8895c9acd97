#pragma once
/// \file scoring_subset.hpp  The quads on which hypotheses are scored.

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "pose/quads.hpp"

namespace quadedge::pose {

/// Buffers of balanced_subset(), kept between calls.
struct SubsetWorkspace {
  struct Cell {
    std::size_t begin, size;
  };
  std::vector<std::int32_t> cell_of, cell_first, members;  ///< quads by cell
  std::vector<Cell> cells;
  std::vector<std::size_t> cell_sizes;
};

/// `size` different rows of 0 .. count - 1 in random order.
void random_subset(std::mt19937_64& random, std::size_t count, std::size_t size, std::vector<std::int32_t>& rows);

/// At most `size` different rows, the same number from each square cell of the current left image: as many as the
/// median cell has, or all that a cell has. So a thing counts by the area that it covers, not by the edges it is
/// covered with. Cells and rows come in random order.
/// \param side of a cell [px] \param rows replaced
void balanced_subset(std::mt19937_64& random, const ScoringArrays& quads, double side, std::size_t size,
                     SubsetWorkspace& workspace, std::vector<std::int32_t>& rows);

}  // namespace quadedge::pose
