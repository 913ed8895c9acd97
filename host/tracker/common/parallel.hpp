#pragma once
/// \file parallel.hpp  Parallel loops over many rows and clones of functions for several vector widths, with results
/// that do not depend on the processor.

#include <algorithm>
#include <cstddef>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <vector>

/// To be placed before functions with plain loops over a fixed number of lanes. Without contraction into fused
/// operations (-ffp-contract=off), all clones give identical bits. Sanitizers run before the clone is chosen; with
/// them, there is only one.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__)
#define QUADEDGE_VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define QUADEDGE_VECTOR_CLONES
#endif

namespace quadedge {

/// Processors that the loops of one object use at most: sixteen were no faster than eight and took a third more of
/// their time.
class Processors {
 public:
  template <class Function>
  auto run(const Function& function) {
    return arena_.execute(function);
  }

 private:
  tbb::task_arena arena_{std::min(8, tbb::this_task_arena::max_concurrency())};
};

constexpr std::size_t kBlockRows = 1024;

inline std::size_t block_count(std::size_t rows) { return (rows + kBlockRows - 1) / kBlockRows; }

/// Number of rows below which a loop is not parallelised if a row takes nanoseconds.
constexpr std::size_t kCheapRows = 16 * kBlockRows;

/// Calls body(block, begin, end) for consecutive blocks of rows, concurrently and in any order; sequentially if there
/// are at most `alone` rows.
template <class Body>
void for_row_blocks(std::size_t rows, Body&& body, std::size_t alone = kBlockRows) {
  const auto one = [&](std::size_t block) {
    body(block, block * kBlockRows, std::min(rows, (block + 1) * kBlockRows));
  };
  if (rows <= alone) {
    for (std::size_t block = 0; block < block_count(rows); ++block) one(block);
  } else {
    tbb::parallel_for(std::size_t{0}, block_count(rows), one);
  }
}

/// Sum over all rows: body(begin, end, sum) adds the rows of a block to a sum initialised with `zero`; the sums of the
/// blocks are added in order. `alone`: see for_row_blocks().
template <class Sum, class Body>
Sum sum_row_blocks(std::size_t rows, const Sum& zero, Body&& body, std::size_t alone = kBlockRows) {
  Sum total = zero;
  if (rows <= kBlockRows) {
    body(std::size_t{0}, rows, total);
    return total;
  }
  std::vector<Sum> sums(block_count(rows), zero);
  for_row_blocks(
      rows, [&](std::size_t block, std::size_t begin, std::size_t end) { body(begin, end, sums[block]); }, alone);
  for (const Sum& sum : sums) total += sum;
  return total;
}

/// The same for sums that own memory, which `blocks` and `total` keep between calls.
template <class Sum, class Body>
void sum_row_blocks(std::size_t rows, const Sum& zero, std::vector<Sum>& blocks, Sum& total, Body&& body) {
  const std::size_t count = block_count(rows);
  if (blocks.size() < count) blocks.resize(count, zero);
  for_row_blocks(rows, [&](std::size_t block, std::size_t begin, std::size_t end) {
    blocks[block] = zero;
    body(begin, end, blocks[block]);
  });
  total = zero;
  for (std::size_t block = 0; block < count; ++block) total += blocks[block];
}

}  // namespace quadedge
