#include "report/plot_frame.hpp"

#include <algorithm>

#include "report/svg.hpp"

namespace quadedge::report {
namespace {

constexpr double kFont = 11, kTitleFont = 13;  // px
constexpr double kLegendLine = 16, kSwatch = 16, kRight = 14;
constexpr const char* kGrid = "stroke=\"#e4e4e4\"";
constexpr const char* kInk = "stroke=\"#888\"";

}  // namespace

PlotFrame::PlotFrame(int width, int height, const std::string& title, const std::string& x_label,
                     const std::string& y_label, const std::vector<LegendEntry>& legend,
                     const std::vector<Tick>& y_ticks, double bottom, double left)
    : width_(width), height_(height), title_(title), x_label_(x_label), y_label_(y_label), legend_(legend) {
  double widest = 0;
  for (const auto& tick : y_ticks) widest = std::max(widest, svg::text_width(tick.label, kFont));
  area_.left = std::max(left, widest + (y_label.empty() ? 12 : 28));
  area_.right = width - kRight;
  int lines = 0;
  double x = area_.left;
  for (const auto& entry : legend_) {
    const double wide = kSwatch + 5 + svg::text_width(entry.name, kFont) + 12;
    if (lines == 0) lines = 1;
    if (x > area_.left && x + wide > width) x = area_.left, ++lines;
    legend_x_.push_back(x);
    legend_line_.push_back(lines - 1);
    x += wide;
  }
  area_.top = (title.empty() ? 8 : 26) + lines * kLegendLine + (lines > 0 ? 4 : 0);
  area_.bottom = height - bottom;
}

std::string PlotFrame::decorations() const {
  std::string result;
  if (!title_.empty()) {
    result +=
        svg::text(area_.left, 16, title_, svg::Anchor::start, "font-size=\"13\" font-weight=\"600\" fill=\"#111\"");
  }
  const double legend_top = (title_.empty() ? 8 : 26) + 9;
  for (std::size_t i = 0; i < legend_.size(); ++i) {
    const double x = legend_x_[i], y = legend_top + legend_line_[i] * kLegendLine;
    const std::string colour = "\"" + legend_[i].colour + "\"";
    if (legend_[i].dot) {
      result += "<circle cx=\"" + svg::number(x + kSwatch / 2) + "\" cy=\"" + svg::number(y - 4) +
                "\" r=\"3.5\" fill=" + colour + "/>";
    } else {
      result += svg::line(
          x, y - 4, x + kSwatch, y - 4,
          "stroke=" + colour + " stroke-width=\"2.5\"" + (legend_[i].dashed ? " stroke-dasharray=\"5 3\"" : ""));
    }
    result += svg::text(x + kSwatch + 5, y, legend_[i].name, svg::Anchor::start);
  }
  if (!x_label_.empty())
    result += svg::text((area_.left + area_.right) / 2, height_ - 5, x_label_, svg::Anchor::middle);
  if (!y_label_.empty()) {
    const std::string middle = svg::number((area_.top + area_.bottom) / 2);
    result += svg::text(0, 0, y_label_, svg::Anchor::middle, "transform=\"translate(11 " + middle + ") rotate(-90)\"");
  }
  return result;
}

std::string PlotFrame::vertical_axis(const PlotAxis& axis, const std::vector<Tick>& ticks) const {
  std::string result;
  for (const auto& tick : ticks) {
    const double y = area_.bottom - axis.share(tick.value) * area_.height();
    result += svg::line(area_.left, y, area_.right, y, kGrid);
    result += svg::text(area_.left - 5, y + 4, tick.label, svg::Anchor::end);
  }
  return result;
}

std::string PlotFrame::horizontal_axis(const PlotAxis& axis, const std::vector<Tick>& ticks) const {
  std::string result;
  for (const auto& tick : ticks) {
    const double x = area_.left + axis.share(tick.value) * area_.width();
    result += svg::line(x, area_.top, x, area_.bottom, kGrid);
    result += svg::line(x, area_.bottom, x, area_.bottom + 4, kInk);
    result += svg::text(x, area_.bottom + 15, tick.label, svg::Anchor::middle);
  }
  return result;
}

std::string PlotFrame::border() const {
  return "<rect x=\"" + svg::number(area_.left) + "\" y=\"" + svg::number(area_.top) + "\" width=\"" +
         svg::number(area_.width()) + "\" height=\"" + svg::number(area_.height()) + "\" fill=\"none\" " + kInk + "/>";
}

}  // namespace quadedge::report
