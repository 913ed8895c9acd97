#pragma once
/// \file plot_frame.hpp  What all plots have around their data: title, legend, axes with ticks, grid.

#include <string>
#include <vector>

#include "report/plot_axis.hpp"

namespace quadedge::report {

/// The rectangle of the data within a picture [px].
struct PlotArea {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

/// One entry of a legend.
struct LegendEntry {
  std::string name, colour;
  bool dot = false;  ///< a dot instead of a stroke
  bool dashed = false;
};

/// Title, legend and labels with the space that they take.
class PlotFrame {
 public:
  /// `bottom`: height of what stands below the data, `left`: of what stands beside it, where that is more than the
  /// labels of `y_ticks` need [px].
  PlotFrame(int width, int height, const std::string& title, const std::string& x_label, const std::string& y_label,
            const std::vector<LegendEntry>& legend, const std::vector<Tick>& y_ticks, double bottom, double left = 0);

  const PlotArea& area() const { return area_; }
  /// Title, legend, labels of the axes.
  std::string decorations() const;
  /// Grid lines and labels of the vertical axis.
  std::string vertical_axis(const PlotAxis& axis, const std::vector<Tick>& ticks) const;
  /// Ticks and labels of a horizontal axis of numbers.
  std::string horizontal_axis(const PlotAxis& axis, const std::vector<Tick>& ticks) const;
  /// The line around the data.
  std::string border() const;

 private:
  int width_, height_;
  std::string title_, x_label_, y_label_;
  std::vector<LegendEntry> legend_;
  std::vector<double> legend_x_;
  std::vector<int> legend_line_;
  PlotArea area_;
};

/// Height of the tick labels and the label of a horizontal axis of numbers [px].
inline constexpr double kNumberAxisHeight = 36;

}  // namespace quadedge::report
