#pragma once
/// \file statistics.hpp  Medians and percentiles of measured values.

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/numeric.hpp"

namespace quadedge::report {

/// Value below which `fraction` (0 to 1) of the values lie, interpolated linearly between neighbours; NaN for no
/// values.
inline double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return kNan;
  std::sort(values.begin(), values.end());
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const auto above = std::min(below + 1, values.size() - 1);
  const double part = position - std::floor(position);
  return values[below] + part * (values[above] - values[below]);
}

/// Middle value; NaN for no values.
inline double median(const std::vector<double>& values) { return percentile(values, 0.5); }

}  // namespace quadedge::report
