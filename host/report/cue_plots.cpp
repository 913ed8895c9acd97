/// \file cue_plots.cpp  Histograms as densities and cumulative curves.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "report/canvas.hpp"
#include "report/matching_plots.hpp"

namespace quadedge::report {
namespace {

using evaluation::CueDistribution;
using evaluation::Histogram;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostPoints = 130;  // of a curve; finer bins are joined

double value_at(const Histogram& histogram, std::size_t bin) {
  return histogram.low + static_cast<double>(bin) * histogram.width();
}

/// Value below which a fraction of all values lies, to within a bin.
double quantile(const Histogram& histogram, double fraction) {
  const double wanted = fraction * static_cast<double>(histogram.total());
  double sum = static_cast<double>(histogram.below);
  for (std::size_t bin = 0; bin < histogram.bins.size(); ++bin) {
    sum += static_cast<double>(histogram.bins[bin]);
    if (sum >= wanted) return value_at(histogram, bin + 1);
  }
  return histogram.high;
}

/// The part of the axis that is worth showing: all thresholds, nearly all veridical pairs, and so much of the others
/// that one sees where they begin.
std::pair<double, double> shown_range(const CueDistribution& cue) {
  const Histogram &veridical = cue.veridical, &other = cue.other;
  double low = cue.thresholds.empty() ? veridical.high : cue.thresholds[0];
  double high = cue.thresholds.empty() ? veridical.low : cue.thresholds[0];
  for (const double threshold : cue.thresholds) low = std::min(low, threshold), high = std::max(high, threshold);
  if (cue.keeps_small) {
    high *= 2;
    low = std::min(0.0, veridical.total() > 0 ? quantile(veridical, 0.001) : 0.0);
  } else if (other.total() > 0) {
    low = std::min(low, quantile(other, 0.01));
  }
  if (veridical.total() > 0) {
    low = std::min(low, quantile(veridical, 0.001));
    high = std::max(high, quantile(veridical, 0.999));
  }
  const double air = 0.04 * (high - low);
  return {std::max(veridical.low, low - (low == 0 ? 0 : air)), std::min(veridical.high, high + air)};
}

struct Curves {
  std::vector<double> values, density, cumulative_values, cumulative;
};

/// Density over the bins within the range, and the cumulative fraction of all values at the ends of bins.
Curves curves_of(const Histogram& histogram, double low, double high) {
  Curves curves;
  const auto bin_of = [&](double value) {
    const double last_bin = static_cast<double>(histogram.bins.size());
    return static_cast<std::size_t>(std::clamp((value - histogram.low) / histogram.width(), 0.0, last_bin));
  };
  const std::size_t first = bin_of(low), last = std::min(bin_of(high) + 1, histogram.bins.size());
  const std::size_t join = std::max<std::size_t>(1, (last - first + kMostPoints - 1) / kMostPoints);
  double sum = static_cast<double>(histogram.below), inside = 0;
  for (std::size_t bin = 0; bin < last; ++bin) {
    if (bin < first) {
      sum += static_cast<double>(histogram.bins[bin]);
    } else {
      inside += static_cast<double>(histogram.bins[bin]);
    }
  }
  const double total = static_cast<double>(histogram.total());
  curves.cumulative_values.push_back(value_at(histogram, first));
  curves.cumulative.push_back(total > 0 ? 100 * sum / total : kNan);
  for (std::size_t bin = first; bin < last; bin += join) {
    const std::size_t end = std::min(bin + join, last);
    const double count = static_cast<double>(std::accumulate(histogram.bins.begin() + static_cast<std::ptrdiff_t>(bin),
                                                             histogram.bins.begin() + static_cast<std::ptrdiff_t>(end),
                                                             std::int64_t{0}));
    sum += count;
    curves.values.push_back(0.5 * (value_at(histogram, bin) + value_at(histogram, end)));
    curves.density.push_back(inside > 0 ? count / inside / (value_at(histogram, end) - value_at(histogram, bin))
                                        : kNan);
    curves.cumulative_values.push_back(value_at(histogram, end));
    curves.cumulative.push_back(total > 0 ? 100 * sum / total : kNan);
  }
  return curves;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// 27230 as "27.2k".
std::string short_count(std::int64_t count) {
  const double value = static_cast<double>(count);
  if (count >= 10'000'000) return fixed(value / 1e6, 0) + "M";
  if (count >= 1'000'000) return fixed(value / 1e6, 1) + "M";
  if (count >= 10'000) return fixed(value / 1e3, 0) + "k";
  if (count >= 1'000) return fixed(value / 1e3, 1) + "k";
  return std::to_string(count);
}

}  // namespace

std::vector<std::string> cue_plots(const CueDistribution& cue) {
  const auto range = shown_range(cue);
  const double low = range.first, high = range.second;
  const std::string axis = cue.cue + (cue.unit.empty() ? "" : " [" + cue.unit + "]");
  const std::string density_unit = cue.unit.empty() ? "" : " [1/" + cue.unit + "]";
  Plot density = small_plot(std::to_string(cue.order) + "  " + cue.cue, axis, "density" + density_unit);
  Plot cumulative = small_plot("cumulative", axis, "fraction of pairs [%]");
  for (auto* plot : {&density, &cumulative}) plot->x_low = low, plot->x_high = high;
  cumulative.y_low = 0, cumulative.y_high = 102;
  const auto add = [&](const std::string& name, const Histogram& histogram) {
    const Curves curves = curves_of(histogram, low, high);
    density.add_area(name + " (" + short_count(histogram.total()) + ")", curves.values, curves.density);
    cumulative.add_line(name, curves.cumulative_values, curves.cumulative);
  };
  add("veridical", cue.veridical);
  add("other", cue.other);
  // Pooled data sets may have thresholds of their own: then one label names them all.
  auto thresholds = cue.thresholds;
  std::sort(thresholds.begin(), thresholds.end());
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    std::string label = (cue.keeps_small ? "\u2264 " : "\u2265 ") + short_number(thresholds[i]);
    if (i + 1 < thresholds.size()) {
      label.clear();
    } else if (i > 0) {
      label = short_number(thresholds[0]) + " to " + short_number(thresholds[i]) + ", per data set";
    }
    density.add_marker_line(thresholds[i], label);
    cumulative.add_marker_line(thresholds[i], label, cue.keeps_small);
  }
  return {density.svg(), cumulative.svg()};
}

std::vector<std::string> disparity_error_plots(const std::vector<evaluation::MatchingResult>& results) {
  constexpr double kRange = 1.5;  // px
  Histogram signed_error(-kRange, kRange, 120), absolute(0, kRange, 150);
  for (const auto& result : results) {
    for (const auto& frame : result.frames) {
      for (const float error : frame.disparity_error) {
        signed_error.add(error);
        absolute.add(std::abs(error));
      }
    }
  }
  Plot density = small_plot("Error of the disparity", "error [px]", "density [1/px]");
  Plot cumulative = small_plot("Error within a limit", "largest absolute error [px]", "fraction of edges [%]");
  const Curves curves = curves_of(signed_error, -kRange, kRange);
  density.add_area("final stereo edges (" + short_count(signed_error.total()) + ")", curves.values, curves.density);
  const Curves within = curves_of(absolute, 0, kRange);
  cumulative.add_line("final stereo edges", within.cumulative_values, within.cumulative);
  cumulative.y_low = 0, cumulative.y_high = 102;
  return {density.svg(), cumulative.svg()};
}

}  // namespace quadedge::report
