#pragma once
/// \file plot_axis.hpp  One axis of a plot: its range and its ticks.

#include <optional>
#include <string>
#include <vector>

namespace quadedge::report {

/// A labelled position on an axis.
struct Tick {
  double value;
  std::string label;
};

/// A linear or logarithmic axis from `low` to `high`.
class PlotAxis {
 public:
  /// An empty range grows around its value, one of a logarithmic axis that reaches zero or below is cut there.
  PlotAxis(double low, double high, bool logarithmic);

  /// The range of the finite values (of the positive ones on a logarithmic axis) with a little air; it begins at zero
  /// where the values come near zero. `low` and `high`, where given, hold. Without any value: 0 to 1, or 0.1 to 1.
  static PlotAxis around(const std::vector<double>& values, bool logarithmic, std::optional<double> low = {},
                         std::optional<double> high = {});

  double low() const { return low_; }
  double high() const { return high_; }
  bool logarithmic() const { return logarithmic_; }
  /// 0 at `low`, 1 at `high`; NaN for a value that a logarithmic axis cannot show.
  double share(double value) const;
  /// Round values within the range, about `wanted` of them (at most a third more), each with as many digits as it takes
  /// to tell them apart.
  std::vector<Tick> ticks(int wanted) const;

 private:
  double low_, high_;
  bool logarithmic_;
};

/// A value as an axis prints it: thousands as "k", millions as "M".
std::string axis_number(double value, int decimals);

}  // namespace quadedge::report
