#include "reference/scan.hpp"

#include <algorithm>

namespace quadedge::reference {

Scan scan(const std::vector<std::int32_t>& counts, std::int32_t capacity) {
  Scan result;
  std::int32_t sum = 0;
  for (const std::int32_t count : counts) {
    result.first.push_back(std::min(sum, capacity));
    sum += count;
  }
  result.fitting = std::min(sum, capacity);
  result.first.push_back(result.fitting);
  result.cut_off = sum - result.fitting;
  return result;
}

}  // namespace quadedge::reference
