#include "report/svg_bars.hpp"

#include <algorithm>
#include <cmath>

#include "quadedge/error.hpp"
#include "report/plot_frame.hpp"
#include "report/svg.hpp"

namespace quadedge::report {
namespace {

constexpr std::size_t kLongestName = 22;                            // characters
constexpr double kGroup = 0.78;                                     // fraction of a category's width that its bars take
constexpr double kWidestBar = 56;                                   // px
constexpr double kSlantSine = 0.5735764, kSlantCosine = 0.8191520;  // of 35 degrees

std::string shortened(const std::string& name) {
  if (name.size() <= kLongestName) return name;
  std::size_t end = kLongestName - 2;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;  // not within a character of UTF-8
  return name.substr(0, end) + "..";
}

}  // namespace

void BarChart::add_series(const std::string& name, const std::vector<double>& values) {
  if (values.size() != categories.size()) {
    throw UsageError("bar chart '" + title + "': series '" + name + "' has " + std::to_string(values.size()) +
                     " values for " + std::to_string(categories.size()) + " categories");
  }
  series_.push_back({name, values});
}

std::string BarChart::svg() const {
  std::vector<double> values = {0};
  std::vector<LegendEntry> legend;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    values.insert(values.end(), series_[s].values.begin(), series_[s].values.end());
    if (!series_[s].name.empty()) legend.push_back({series_[s].name, svg::series_colour(s), false, false});
  }
  double widest = 0;
  for (const auto& category : categories) widest = std::max(widest, svg::text_width(shortened(category), 11));
  const double about_one = (width - 60.0) / static_cast<double>(std::max<std::size_t>(categories.size(), 1));
  // Numbers that do not fit are left out in turn, names are slanted.
  const bool numbers = std::all_of(categories.begin(), categories.end(), [](const std::string& name) {
    return name.find_first_not_of("0123456789.-+k") == std::string::npos;
  });
  const bool slanted = !numbers && widest + 6 > about_one;
  const double label_space = x_label.empty() ? 4 : 18;
  const double bottom = (slanted ? 14 + kSlantSine * widest : 18) + label_space;
  const double left = slanted ? kSlantCosine * svg::text_width(shortened(categories[0]), 11) - about_one / 2 + 8 : 0;

  const PlotAxis axis = PlotAxis::around(values, false, {}, y_high);
  const auto ticks = axis.ticks(std::max(2, static_cast<int>((height - bottom - 50) / 34)));
  const PlotFrame frame(width, height, title, x_label, y_label, legend, ticks, bottom, left);
  const PlotArea& area = frame.area();
  std::string result = svg::open(width, height, title.empty() ? y_label : title) + frame.decorations() +
                       frame.vertical_axis(axis, ticks);

  const double one = area.width() / static_cast<double>(std::max<std::size_t>(categories.size(), 1));
  const double series = static_cast<double>(std::max<std::size_t>(series_.size(), 1));
  const double bar = std::min(kGroup * one / series, kWidestBar);
  const auto place_y = [&](double value) {
    return area.bottom - std::clamp(axis.share(value), 0.0, 1.0) * area.height();
  };
  const std::size_t every = static_cast<std::size_t>(std::max(1.0, std::ceil((slanted ? 15 : widest + 6) / one)));
  for (std::size_t c = 0; c < categories.size(); ++c) {
    const double from = area.left + (static_cast<double>(c) + 0.5) * one - 0.5 * series * bar;
    for (std::size_t s = 0; s < series_.size(); ++s) {
      const double value = series_[s].values[c];
      if (!std::isfinite(value)) continue;
      const double top = place_y(std::max(value, 0.0)), base = place_y(std::min(value, 0.0));
      result += "<rect x=\"" + svg::number(from + static_cast<double>(s) * bar) + "\" y=\"" + svg::number(top) +
                "\" width=\"" + svg::number(std::max(bar - 1, 0.8)) + "\" height=\"" + svg::number(base - top) +
                "\" fill=\"" + svg::series_colour(s) + "\"/>";
    }
    if (c % every != 0) continue;
    const double x = area.left + (static_cast<double>(c) + 0.5) * one;
    if (slanted) {
      const std::string where =
          "transform=\"translate(" + svg::number(x + 4) + " " + svg::number(area.bottom + 11) + ") rotate(-35)\"";
      result += svg::text(0, 0, shortened(categories[c]), svg::Anchor::end, where);
    } else {
      result += svg::text(x, area.bottom + 14, shortened(categories[c]), svg::Anchor::middle);
    }
  }
  if (categories.empty() || series_.empty()) {
    result += svg::text((area.left + area.right) / 2, (area.top + area.bottom) / 2, "no data", svg::Anchor::middle,
                        "fill=\"#888\"");
  }
  return result + frame.border() + "</svg>\n";
}

}  // namespace quadedge::report
