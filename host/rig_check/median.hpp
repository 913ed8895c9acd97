#pragma once
/// \file median.hpp  Median of a list.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace quadedge::rig_check {

/// The median of at least one value; the list is reordered.
inline double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace quadedge::rig_check
