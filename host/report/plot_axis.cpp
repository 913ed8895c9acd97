#include "report/plot_axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace quadedge::report {
namespace {

constexpr double kAir = 0.04;            // of the range, beyond the outermost values
constexpr int kSmallestWrittenOut = -4;  // powers of ten below are written as "1e-5"

/// The round number (1, 2 or 5 times a power of ten) near `step`: at most a quarter below it.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= 0.75 * step) return factor * power;
  }
  return 10 * power;
}

int decimals_of(double step) { return std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))); }

}  // namespace

std::string axis_number(double value, int decimals) {
  const char* suffix = "";
  if (decimals == 0 && std::abs(value) >= 1e6) {
    value /= 1e6, suffix = "M";
  } else if (decimals == 0 && std::abs(value) >= 1e4) {
    value /= 1e3, suffix = "k";
  }
  char text[64];
  if (*suffix != '\0') {
    std::snprintf(text, sizeof text, "%g%s", value, suffix);
  } else {
    std::snprintf(text, sizeof text, "%.*f", decimals, value == 0 ? 0.0 : value);
  }
  return text;
}

PlotAxis::PlotAxis(double low, double high, bool logarithmic) : low_(low), high_(high), logarithmic_(logarithmic) {
  if (logarithmic_) {
    if (!(high_ > 0)) high_ = 1;
    if (!(low_ > 0) || !(low_ < high_)) low_ = high_ / 10;
  } else if (!(high_ > low_)) {
    const double half = std::max(std::abs(low_) * 0.1, 0.5);
    low_ -= half;
    high_ = low_ + 2 * half;
  }
}

PlotAxis PlotAxis::around(const std::vector<double>& values, bool logarithmic, std::optional<double> low,
                          std::optional<double> high) {
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && !(value > 0))) continue;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  if (!(smallest <= largest)) return {low.value_or(logarithmic ? 0.1 : 0.0), high.value_or(1.0), logarithmic};
  if (logarithmic) {
    const double air = std::pow(largest / smallest, kAir) * (smallest == largest ? 2 : 1);
    return {low.value_or(smallest / air), high.value_or(largest * air), true};
  }
  const double air = kAir * (largest - smallest);
  const bool from_zero = smallest >= 0 && smallest < 0.4 * largest;
  const bool to_zero = largest <= 0 && largest > 0.4 * smallest;
  return {low.value_or(from_zero ? 0.0 : smallest - air), high.value_or(to_zero ? 0.0 : largest + air), false};
}

double PlotAxis::share(double value) const {
  if (!logarithmic_) return (value - low_) / (high_ - low_);
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::log(value / low_) / std::log(high_ / low_);
}

std::vector<Tick> PlotAxis::ticks(int wanted) const {
  std::vector<Tick> ticks;
  if (logarithmic_ && high_ / low_ >= 10) {
    const int first = static_cast<int>(std::floor(std::log10(low_))),
              last = static_cast<int>(std::ceil(std::log10(high_)));
    const int every = std::max(1, (last - first) / std::max(wanted, 1));
    const bool between = last - first <= 2;
    for (int power = first; power <= last; power += every) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double value = factor * std::pow(10.0, power);
        if ((factor > 1 && !between) || value < low_ * (1 - 1e-9) || value > high_ * (1 + 1e-9)) continue;
        char small[16];
        std::snprintf(small, sizeof small, "%ge%d", factor, power);
        ticks.push_back({value, power < kSmallestWrittenOut ? small : axis_number(value, std::max(0, -power))});
      }
    }
    return ticks;
  }
  const double step = round_step((high_ - low_) / std::max(wanted, 1));
  for (double k = std::ceil(low_ / step - 1e-9); k * step <= high_ + 1e-9 * step; ++k) {
    ticks.push_back({k * step, axis_number(k * step, decimals_of(step))});
  }
  return ticks;
}

}  // namespace quadedge::report
