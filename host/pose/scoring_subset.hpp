#pragma once
/// \file scoring_subset.hpp  Selects the quads on which hypotheses are scored.

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

/// `size` distinct rows of 0 .. count - 1, in random order.
void random_subset(std::mt19937_64& random, std::size_t count, std::size_t size, std::vector<std::int32_t>& rows);

/// At most `size` distinct rows, evenly from the square cells of the current left image: from each cell as many as the
/// median cell contains, or all if it has fewer. Objects are thus weighted by area, not by their number of edges. Cells
/// and rows are in random order.
/// \param side side of a cell [px] \param rows replaced
void balanced_subset(std::mt19937_64& random, const ScoringArrays& quads, double side, std::size_t size,
                     SubsetWorkspace& workspace, std::vector<std::int32_t>& rows);

}  // namespace quadedge::pose
