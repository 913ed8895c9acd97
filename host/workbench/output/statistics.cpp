/// \file statistics.cpp  Sorts a copy and interpolates between the two nearest ranks.
#include "output/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadedge::report {

double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const auto above = std::min(below + 1, values.size() - 1);
  const double part = position - std::floor(position);
  return values[below] + part * (values[above] - values[below]);
}

}  // namespace quadedge::report
