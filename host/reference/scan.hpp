#pragma once
/// \file scan.hpp  Plain C++ twin of kernels/scan.cl.

#include <cstdint>
#include <vector>

namespace quadedge::reference {

/// Starts of rows in a list with room for `capacity` elements.
struct Scan {
  std::vector<std::int32_t> first;  ///< size counts + 1: min(counts[0] + ... + counts[i - 1], capacity)
  std::int32_t fitting = 0;         ///< elements that fit
  std::int32_t cut_off = 0;         ///< elements beyond the capacity
};

/// Exclusive prefix sums of counts that are not negative.
Scan scan(const std::vector<std::int32_t>& counts, std::int32_t capacity);

}  // namespace quadedge::reference
