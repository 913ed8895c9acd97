#pragma once
/// \file pair_search.hpp  The loop of a consensus search over pairs of quads.

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <random>
#include <tbb/parallel_for.h>
#include <vector>

#include "motion/sampling_order.hpp"

namespace quadedge::pose {

/// Pairs that are drawn one by one, which most searches do not exceed; then so many are solved together, in parallel
/// by blocks.
constexpr int kDrawsAlone = 256;
constexpr std::size_t kDrawsTogether = 256, kDrawsPerBlock = 16;

/// The ranks of two quads that were drawn, and the motion that they give, if they give one.
struct PairSample {
  std::size_t first, second;
  std::optional<Eigen::Isometry3d> motion;
};

/// Draws pairs and tries their motions until `is_done`. Pairs that are drawn together are all solved, also those behind
/// the end of the search: where it ends does not depend on how many are solved together.
/// \param draws is counted \param drawn a buffer that is kept between calls
/// \param pool_of (number of a draw): from how many of the first ranks it is made, at least 2
/// \param solve (rank, rank, block): the motion of a pair, or nothing; calls with different blocks may be parallel
/// \param consider (motion): what is done with it
template <class Pool, class Solve, class IsDone, class Consider>
void try_pairs(std::mt19937_64& random, int& draws, std::vector<PairSample>& drawn, Pool pool_of, Solve solve,
               IsDone is_done, Consider consider) {
  const auto solve_block = [&](std::size_t block) {
    const std::size_t end = std::min(drawn.size(), (block + 1) * kDrawsPerBlock);
    for (std::size_t i = block * kDrawsPerBlock; i < end; ++i)
      drawn[i].motion = solve(drawn[i].first, drawn[i].second, block);
  };
  while (!is_done()) {
    drawn.clear();
    const std::size_t together = draws < kDrawsAlone ? 1 : kDrawsTogether;
    while (drawn.size() < together) {
      const std::size_t pool = pool_of(draws + static_cast<int>(drawn.size()));
      const std::size_t a = random_index(random, pool), b = random_index(random, pool - 1);
      drawn.push_back({a, b + (b >= a ? 1 : 0), std::nullopt});
    }
    if (together == 1)
      solve_block(0);
    else
      tbb::parallel_for(std::size_t{0}, kDrawsTogether / kDrawsPerBlock, solve_block);
    for (std::size_t i = 0; i < together && !is_done(); ++i) {
      ++draws;
      if (drawn[i].motion) consider(*drawn[i].motion);
    }
  }
}

}  // namespace quadedge::pose
