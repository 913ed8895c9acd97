#pragma once
/// \file sampling_order.hpp  Random indices, the order in which quads enter the samples of a consensus search, and
/// the quads on which hypotheses are scored.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include "motion/quads.hpp"

namespace quadedge::pose {

/// Uniform over 0 .. count - 1 (std::uniform_int_distribution differs between libraries).
inline std::size_t random_index(std::mt19937_64& random, std::size_t count) {
  return static_cast<std::size_t>(((random() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

/// Bits of a number as an unsigned integer with the same order.
inline std::uint32_t ordered_bits(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

/// Quads by matching quality: fewest competing clusters, then highest NCC, then lowest index. Only as many as requested
/// are sorted.
class SamplingOrder {
 public:
  /// The sort key of a quad, smallest first, and the quad.
  using Entry = std::pair<std::uint64_t, std::int32_t>;

  /// \param order a buffer that is kept between calls
  SamplingOrder(const QuadObservations& quads, std::vector<Entry>& order) : order_(order) {
    order_.resize(quads.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const auto competing = static_cast<std::uint64_t>(static_cast<std::uint32_t>(quads.competing_clusters[i]));
      order_[i] = {competing << 32 | ~ordered_bits(quads.ncc[i]), static_cast<std::int32_t>(i)};
    }
  }

  /// Sorts the first `count` quads.
  void sort_first(std::size_t count) {
    if (count <= sorted_) return;
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    sorted_ = std::min(order_.size(), std::max(count, kGrowth * sorted_));
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    std::nth_element(begin, end, order_.end());
    std::sort(begin, end);
  }
  std::size_t size() const { return order_.size(); }
  std::size_t operator[](std::size_t rank) const { return static_cast<std::size_t>(order_[rank].second); }

 private:
  /// Factor by which the sorted part grows, because each extension passes over all remaining quads.
  static constexpr std::size_t kGrowth = 4;

  std::vector<Entry>& order_;
  std::size_t sorted_ = 0;
};

// Selects the quads on which hypotheses are scored.

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
