#pragma once
/// \file svg_plot.hpp  Line, area and scatter plots as SVG, with axes, ticks, legend and marked thresholds.

#include <optional>
#include <string>
#include <vector>

namespace quadedge::report {

struct PlotScale;

/// A plot. Set the public fields, add series, ask for svg(). Labels hold the unit ("distance [px]").
class Plot {
 public:
  std::string title, x_label, y_label;
  int width = 420, height = 290;  ///< px
  bool x_logarithmic = false, y_logarithmic = false;
  bool equal_units = false;                            ///< one unit is as long on x as on y (maps and trajectories)
  std::optional<double> x_low, x_high, y_low, y_high;  ///< ends of the axes; chosen from the data where not given

  /// Values that are not finite break a line. All functions \throw UsageError when xs and ys are not of one size.
  void add_line(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys,
                bool dashed = false);
  /// A line with the space down to the axis filled.
  void add_area(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys);
  /// The space between two curves, filled: one layer of a stack. Values that are not finite are left out.
  void add_band(const std::string& name, const std::vector<double>& xs, const std::vector<double>& lows,
                const std::vector<double>& highs);
  /// Dots.
  void add_points(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys);
  /// A vertical line across the plot with its label beside it, at the top or at the bottom: a threshold.
  void add_marker_line(double x, const std::string& label, bool label_at_bottom = false);

  /// The picture: one <svg> element without references, which stands alone in a file and inside a page.
  std::string svg() const;

 private:
  enum class Style { line, dashed, area, band, points };
  struct Series {
    std::string name;
    std::vector<double> xs, ys;
    Style style;
    std::vector<double> lows;  ///< of a band
  };
  struct Marker {
    double x;
    std::string label;
    bool label_at_bottom;
  };
  void add(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys, Style style);

  struct DrawnSeries;
  DrawnSeries draw_series(const PlotScale& scale) const;
  std::string draw_markers(const PlotScale& scale) const;

  std::vector<Series> series_;
  std::vector<Marker> markers_;
};

}  // namespace quadedge::report
