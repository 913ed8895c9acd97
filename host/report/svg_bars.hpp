#pragma once
/// \file svg_bars.hpp  Bar charts as SVG: one group of bars per category.

#include <optional>
#include <string>
#include <vector>

namespace quadedge::report {

/// A chart of upright bars that stand on zero. Set the fields, add series, ask for svg(). Labels hold the unit.
class BarChart {
 public:
  std::string title, x_label, y_label;
  int width = 420, height = 290;  ///< px
  std::vector<std::string> categories;
  std::optional<double> y_high;  ///< end of the vertical axis; chosen from the data where not given

  /// One value per category, drawn next to those of the other series; NaN: no bar.
  /// \throws UsageError when there are not as many values as categories.
  void add_series(const std::string& name, const std::vector<double>& values);

  /// One <svg> element without references. Category names that do not fit side by side are written at a slant, and
  /// shortened where they are very long.
  std::string svg() const;

 private:
  struct Series {
    std::string name;
    std::vector<double> values;
  };
  std::vector<Series> series_;
};

}  // namespace quadedge::report
