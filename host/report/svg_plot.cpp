#include "report/svg_plot.hpp"

#include <algorithm>
#include <cmath>

#include "quadedge/error.hpp"
#include "report/plot_frame.hpp"
#include "report/svg.hpp"

namespace quadedge::report {

/// From values to positions within the rectangle of the data [px]. What lies far outside is held back, so that numbers
/// stay short.
struct PlotScale {
  const PlotAxis &x, &y;
  double width, height;
  double place_x(double value) const { return std::clamp(x.share(value), -10.0, 11.0) * width; }
  double place_y(double value) const { return (1 - std::clamp(y.share(value), -10.0, 11.0)) * height; }
  bool can_show(double x_value, double y_value) const {
    return std::isfinite(x.share(x_value)) && std::isfinite(y.share(y_value));
  }
};

/// What the series look like.
struct Plot::DrawnSeries {
  bool anything = false;  ///< at least one value can be shown
  std::string curves;
  std::string dots;  ///< drawn whole also at the border
};

namespace {

constexpr double kTickEvery = 56, kVerticalTickEvery = 34;  // px
constexpr double kMarkerFont = 10.5, kMarkerLine = 13;      // px

/// Ticks of a horizontal axis whose labels do not touch.
std::vector<Tick> horizontal_ticks(const PlotAxis& axis, double width) {
  for (int wanted = std::max(2, static_cast<int>(width / kTickEvery));; --wanted) {
    auto ticks = axis.ticks(wanted);
    double needed = 0;
    for (const auto& tick : ticks) needed += svg::text_width(tick.label, 11) + 10;
    if (needed <= width || wanted <= 1) return ticks;
  }
}

/// Widens the axis whose unit is drawn longer, so that both are drawn alike.
void equalise(PlotAxis& x, PlotAxis& y, const PlotArea& area) {
  const double x_unit = area.width() / (x.high() - x.low()), y_unit = area.height() / (y.high() - y.low());
  const auto widened = [](const PlotAxis& axis, double factor) {
    const double centre = 0.5 * (axis.low() + axis.high()), half = 0.5 * factor * (axis.high() - axis.low());
    return PlotAxis(centre - half, centre + half, false);
  };
  if (x_unit > y_unit) {
    x = widened(x, x_unit / y_unit);
  } else {
    y = widened(y, y_unit / x_unit);
  }
}

/// Circles for the values within the plot.
std::string dots(const PlotScale& scale, const std::vector<double>& xs, const std::vector<double>& ys) {
  std::string result;
  for (std::size_t k = 0; k < xs.size(); ++k) {
    if (!scale.can_show(xs[k], ys[k])) continue;
    const double x = scale.place_x(xs[k]), y = scale.place_y(ys[k]);
    if (x < -0.5 || x > scale.width + 0.5 || y < -0.5 || y > scale.height + 0.5) continue;
    result += "<circle cx=\"" + svg::number(x) + "\" cy=\"" + svg::number(y) + "\" r=\"3\"/>";
  }
  return result;
}

/// A line through the values, and the same closed along the axis. Both begin anew after values that cannot be shown.
struct Curve {
  std::string path, filled;
};
Curve curve(const PlotScale& scale, const std::vector<double>& xs, const std::vector<double>& ys) {
  const std::string floor =
      svg::number(scale.place_y(scale.y.logarithmic() ? scale.y.low() : std::max(0.0, scale.y.low())));
  Curve result;
  double first_x = 0, last_x = 0;
  bool pen_down = false;
  for (std::size_t k = 0; k <= xs.size(); ++k) {
    if (k == xs.size() || !scale.can_show(xs[k], ys[k])) {
      if (pen_down)
        result.filled += "L" + svg::number(last_x) + " " + floor + "L" + svg::number(first_x) + " " + floor + "Z";
      pen_down = false;
      continue;
    }
    last_x = scale.place_x(xs[k]);
    if (!pen_down) first_x = last_x;
    const std::string step = (pen_down ? "L" : "M") + svg::number(last_x) + " " + svg::number(scale.place_y(ys[k]));
    result.path += step;
    result.filled += step;
    pen_down = true;
  }
  return result;
}

/// The outline of the space between two curves.
std::string band(const PlotScale& scale, const std::vector<double>& xs, const std::vector<double>& lows,
                 const std::vector<double>& highs) {
  std::string there, back;
  for (std::size_t k = 0; k < xs.size(); ++k) {
    if (!scale.can_show(xs[k], lows[k]) || !scale.can_show(xs[k], highs[k])) continue;
    const std::string x = svg::number(scale.place_x(xs[k])) + " ";
    there += (there.empty() ? "M" : "L") + x + svg::number(scale.place_y(highs[k]));
    back.insert(0, "L" + x + svg::number(scale.place_y(lows[k])));
  }
  return there.empty() ? there : there + back + "Z";
}

}  // namespace

void Plot::add(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys, Style style) {
  if (xs.size() != ys.size()) {
    throw UsageError("plot '" + title + "': series '" + name + "' has " + std::to_string(xs.size()) + " x and " +
                     std::to_string(ys.size()) + " y");
  }
  series_.push_back({name, xs, ys, style, {}});
}

void Plot::add_line(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys,
                    bool dashed) {
  add(name, xs, ys, dashed ? Style::dashed : Style::line);
}

void Plot::add_area(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys) {
  add(name, xs, ys, Style::area);
}

void Plot::add_band(const std::string& name, const std::vector<double>& xs, const std::vector<double>& lows,
                    const std::vector<double>& highs) {
  if (lows.size() != highs.size())
    throw UsageError("plot '" + title + "': band '" + name + "' has two sides of different length");
  add(name, xs, highs, Style::band);
  series_.back().lows = lows;
}

void Plot::add_points(const std::string& name, const std::vector<double>& xs, const std::vector<double>& ys) {
  add(name, xs, ys, Style::points);
}

void Plot::add_marker_line(double x, const std::string& label, bool label_at_bottom) {
  markers_.push_back({x, label, label_at_bottom});
}

Plot::DrawnSeries Plot::draw_series(const PlotScale& scale) const {
  DrawnSeries result;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const Series& series = series_[i];
    const std::string& colour = svg::series_colour(i);
    if (series.style == Style::points) {
      const std::string found = dots(scale, series.xs, series.ys);
      result.anything = result.anything || !found.empty();
      result.dots += "<g fill=\"" + colour + "\" fill-opacity=\"0.75\">" + found + "</g>";
      continue;
    }
    if (series.style == Style::band) {
      const std::string outline = band(scale, series.xs, series.lows, series.ys);
      result.anything = result.anything || !outline.empty();
      result.curves += "<path d=\"" + outline + "\" fill=\"" + colour + "\" fill-opacity=\"0.8\"/>";
      continue;
    }
    const Curve drawn = curve(scale, series.xs, series.ys);
    result.anything = result.anything || !drawn.path.empty();
    if (series.style == Style::area)
      result.curves += "<path d=\"" + drawn.filled + "\" fill=\"" + colour + "\" fill-opacity=\"0.15\"/>";
    result.curves += "<path d=\"" + drawn.path + "\" fill=\"none\" stroke=\"" + colour +
                     "\" stroke-width=\"1.8\" stroke-linejoin=\"round\"" +
                     (series.style == Style::dashed ? " stroke-dasharray=\"5 3\"" : "") + "/>";
  }
  return result;
}

std::string Plot::draw_markers(const PlotScale& scale) const {
  std::string result;
  double top_label = 12, bottom_label = scale.height - 6;
  for (const auto& marker : markers_) {
    if (!std::isfinite(scale.x.share(marker.x))) continue;
    const double x = scale.place_x(marker.x);
    result += svg::line(x, 0, x, scale.height, "stroke=\"#111\" stroke-width=\"1.3\" stroke-dasharray=\"3 3\"");
    const bool to_the_left = x + 6 + svg::text_width(marker.label, kMarkerFont) > scale.width;
    if (marker.label.empty()) continue;
    const auto anchor = to_the_left ? svg::Anchor::end : svg::Anchor::start;
    result +=
        svg::text(x + (to_the_left ? -4 : 4), marker.label_at_bottom ? bottom_label : top_label, marker.label, anchor,
                  "font-size=\"10.5\" fill=\"#111\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\"");
    (marker.label_at_bottom ? bottom_label : top_label) += marker.label_at_bottom ? -kMarkerLine : kMarkerLine;
  }
  return result;
}

std::string Plot::svg() const {
  std::vector<double> all_x, all_y;
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const Series& series = series_[i];
    all_x.insert(all_x.end(), series.xs.begin(), series.xs.end());
    all_y.insert(all_y.end(), series.ys.begin(), series.ys.end());
    all_y.insert(all_y.end(), series.lows.begin(), series.lows.end());
    if (series.style == Style::area) all_y.push_back(0);
    if (!series.name.empty()) {
      legend.push_back(
          {series.name, svg::series_colour(i), series.style == Style::points, series.style == Style::dashed});
    }
  }
  for (const auto& marker : markers_) all_x.push_back(marker.x);
  PlotAxis x_axis = PlotAxis::around(all_x, x_logarithmic, x_low, x_high);
  PlotAxis y_axis = PlotAxis::around(all_y, y_logarithmic, y_low, y_high);
  const auto y_ticks_of = [&] {
    return y_axis.ticks(std::max(2, static_cast<int>((height - 90) / kVerticalTickEvery)));
  };
  if (equal_units && !x_logarithmic && !y_logarithmic) {
    equalise(x_axis, y_axis,
             PlotFrame(width, height, title, x_label, y_label, legend, y_ticks_of(), kNumberAxisHeight).area());
  }
  const auto y_ticks = y_ticks_of();
  const PlotFrame frame(width, height, title, x_label, y_label, legend, y_ticks, kNumberAxisHeight);
  const PlotArea& area = frame.area();

  std::string result = svg::open(width, height, title.empty() ? x_label : title) + frame.decorations() +
                       frame.horizontal_axis(x_axis, horizontal_ticks(x_axis, area.width())) +
                       frame.vertical_axis(y_axis, y_ticks);
  // Everything in the inner picture is cut off at its borders.
  result += "<svg x=\"" + svg::number(area.left) + "\" y=\"" + svg::number(area.top) + "\" width=\"" +
            svg::number(area.width()) + "\" height=\"" + svg::number(area.height()) + "\">";
  const PlotScale scale{x_axis, y_axis, area.width(), area.height()};
  const DrawnSeries drawn = draw_series(scale);
  result += drawn.curves + draw_markers(scale);
  if (!drawn.anything)
    result += svg::text(area.width() / 2, area.height() / 2, "no data", svg::Anchor::middle, "fill=\"#888\"");
  return result + "</svg>" + frame.border() + "<g transform=\"translate(" + svg::number(area.left) + " " +
         svg::number(area.top) + ")\">" + drawn.dots + "</g></svg>\n";
}

}  // namespace quadedge::report
