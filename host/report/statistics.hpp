#pragma once
/// \file statistics.hpp  Medians, percentiles and correlations of measured values.

#include <vector>

namespace quadedge::report {

/// Value below which `fraction` (0 to 1) of the values lie, interpolated linearly between neighbours; NaN for no
/// values.
double percentile(std::vector<double> values, double fraction);

/// Middle value; NaN for no values.
inline double median(const std::vector<double>& values) { return percentile(values, 0.5); }

/// Spearman's rank correlation, from -1 to 1; equal values have their mean rank. NaN for fewer than three pairs, or
/// where all values of one kind are equal.
double rank_correlation(const std::vector<double>& xs, const std::vector<double>& ys);

}  // namespace quadedge::report
