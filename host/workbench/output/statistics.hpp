#pragma once
/// \file statistics.hpp  Medians and percentiles of measured values.

#include <vector>

namespace quadedge::report {

/// Value below which `fraction` (0 to 1) of the values lie, interpolated linearly between neighbours; NaN for no
/// values.
double percentile(std::vector<double> values, double fraction);

/// Middle value; NaN for no values.
inline double median(const std::vector<double>& values) { return percentile(values, 0.5); }

}  // namespace quadedge::report
