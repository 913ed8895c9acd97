#include <catch2/catch.hpp>
#include <cmath>

#include "markup.hpp"
#include "quadedge/error.hpp"
#include "report/plot_axis.hpp"
#include "report/svg.hpp"
#include "report/svg_bars.hpp"
#include "report/svg_plot.hpp"

using namespace quadedge;
using namespace quadedge::report;

namespace {

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> result;
  for (const auto& tick : ticks) result.push_back(tick.label);
  return result;
}

/// Size of the inner picture that holds the data [px].
std::pair<double, double> data_size(const std::string& svg) {
  const auto inner = svg.find("<svg x=");
  REQUIRE(inner != std::string::npos);
  const std::string tag = svg.substr(inner, svg.find('>', inner) - inner);
  return {std::stod(all_matches(tag, "width=\"([^\"]+)")[0]), std::stod(all_matches(tag, "height=\"([^\"]+)")[0])};
}

}  // namespace

TEST_CASE("Ticks are round numbers that can be told apart", "[report]") {
  using Labels = std::vector<std::string>;
  CHECK(labels(PlotAxis(0, 1, false).ticks(5)) == Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(labels(PlotAxis(-1.2, 2.6, false).ticks(4)) == Labels{"-1", "0", "1", "2"});
  CHECK(labels(PlotAxis(0, 52000, false).ticks(5)) == Labels{"0", "10k", "20k", "30k", "40k", "50k"});
  CHECK(labels(PlotAxis(0.003, 0.0042, false).ticks(3)) == Labels{"0.0030", "0.0035", "0.0040"});
  CHECK(labels(PlotAxis(0.01, 10, true).ticks(6)) == Labels{"0.01", "0.1", "1", "10"});
  CHECK(labels(PlotAxis(3, 60, true).ticks(6)) == Labels{"5", "10", "20", "50"});
  CHECK(labels(PlotAxis(1e-7, 1e-3, true).ticks(6)) == Labels{"1e-7", "1e-6", "1e-5", "0.0001", "0.001"});
}

TEST_CASE("An axis finds a range for any values", "[report]") {
  const auto near_zero = PlotAxis::around({0.2, 5}, false);
  CHECK(near_zero.low() == 0);
  CHECK(near_zero.high() > 5);
  CHECK(PlotAxis::around({100, 101}, false).low() > 99);
  CHECK(PlotAxis::around({100, 101}, false, 0.0).low() == 0);
  const auto single = PlotAxis::around({7}, false);
  CHECK(single.low() < 7);
  CHECK(single.high() > 7);
  const auto logarithmic = PlotAxis::around({0, -3, 0.01, 10, std::nan("")}, true);
  CHECK(logarithmic.low() > 0);
  CHECK(logarithmic.low() < 0.01);
  CHECK(logarithmic.share(0.1) - logarithmic.share(0.01) == Approx(logarithmic.share(10) - logarithmic.share(1)));
  CHECK(std::isnan(logarithmic.share(0)));
  CHECK(PlotAxis::around({}, false).high() == 1);
}

TEST_CASE("A plot puts values where its axes say, and is well-formed XML whatever its texts", "[report]") {
  Plot plot;
  plot.title = "a < b & \"c\" \x01'd'";
  plot.x_label = "x [px]";
  plot.y_label = "y > 0";
  plot.x_low = 0, plot.x_high = 10, plot.y_low = 0, plot.y_high = 100;
  plot.add_line("rising", {0, 5, 10}, {0, 50, 100});
  plot.add_marker_line(2.5, "threshold <0.6>");
  const std::string svg = plot.svg();
  CHECK(is_well_formed(svg));
  const auto [width, height] = data_size(svg);
  const auto path = all_matches(svg, "<path d=\"(M[^\"]+)\" fill=\"none\"");
  REQUIRE(path.size() == 1);
  const std::string expected = "M0 " + svg::number(height) + "L" + svg::number(width / 2) + " " +
                               svg::number(height / 2) + "L" + svg::number(width) + " 0";
  CHECK(path[0] == expected);
  CHECK(svg.find("<line x1=\"" + svg::number(width / 4) + "\" y1=\"0\" x2=\"" + svg::number(width / 4) + "\" y2=\"" +
                 svg::number(height)) != std::string::npos);
  CHECK(svg.find("threshold &lt;0.6&gt;") != std::string::npos);
  CHECK(svg.find("x [px]") != std::string::npos);
  CHECK(svg.find("rising") != std::string::npos);
}

TEST_CASE("A value that does not exist breaks a line, and an area ends there", "[report]") {
  Plot plot;
  plot.add_area("broken", {0, 1, 2, 3, 4}, {1, 2, std::nan(""), 2, 1});
  const std::string svg = plot.svg();
  CHECK(is_well_formed(svg));
  const auto stroke = all_matches(svg, "<path d=\"([^\"]+)\" fill=\"none\"");
  const auto filled = all_matches(svg, "<path d=\"([^\"]+)\" fill=\"#");
  REQUIRE(stroke.size() == 1);
  REQUIRE(filled.size() == 1);
  CHECK(std::count(stroke[0].begin(), stroke[0].end(), 'M') == 2);
  CHECK(std::count(filled[0].begin(), filled[0].end(), 'Z') == 2);
}

TEST_CASE("With equal units a square is a square", "[report]") {
  Plot plot;
  plot.equal_units = true;
  plot.add_points("corners", {0, 3, 0}, {0, 0, 3});
  const std::string svg = plot.svg();
  const auto x = all_matches(svg, "<circle cx=\"([^\"]+)\" cy=\"[^\"]+\" r=\"3\"/>"),
             y = all_matches(svg, "cy=\"([^\"]+)\" r=\"3\"/>");
  REQUIRE(x.size() == 3);
  REQUIRE(y.size() == 3);
  CHECK(std::stod(x[1]) - std::stod(x[0]) == Approx(std::stod(y[0]) - std::stod(y[2])).margin(0.05));
  plot.equal_units = false;
  const std::string stretched = plot.svg();
  const auto sx = all_matches(stretched, "<circle cx=\"([^\"]+)\" cy=\"[^\"]+\" r=\"3\"/>"),
             sy = all_matches(stretched, "cy=\"([^\"]+)\" r=\"3\"/>");
  CHECK(std::abs((std::stod(sx[1]) - std::stod(sx[0])) - (std::stod(sy[0]) - std::stod(sy[2]))) > 20);
}

TEST_CASE("Plots without data say so, and series of two lengths are refused", "[report]") {
  CHECK(Plot().svg().find("no data") != std::string::npos);
  CHECK(is_well_formed(Plot().svg()));
  CHECK(is_well_formed(BarChart().svg()));
  CHECK(BarChart().svg().find("no data") != std::string::npos);
  Plot plot;
  CHECK_THROWS_AS(plot.add_line("short", {1, 2}, {1}), UsageError);
  BarChart chart;
  chart.categories = {"one"};
  CHECK_THROWS_AS(chart.add_series("long", {1, 2}), UsageError);
}

TEST_CASE("Bars are as high as their values, beside one another", "[report]") {
  BarChart chart;
  chart.y_label = "frames";
  chart.y_high = 40;
  chart.categories = {"room", "cables & more", "a name that is far too long to be printed in full"};
  chart.add_series("left", {10, 20, std::nan("")});
  chart.add_series("right", {30, 40, 5});
  const std::string svg = chart.svg();
  CHECK(is_well_formed(svg));
  const std::string bars = "<rect x=\"([^\"]+)\" y=\"[^\"]+\" width=\"[^\"]+\" height=\"[^\"]+\" fill=\"#";
  const auto x = all_matches(svg, bars), heights = all_matches(svg, "height=\"([^\"]+)\" fill=\"#");
  REQUIRE(x.size() == 5);
  REQUIRE(heights.size() == 5);
  CHECK(std::stod(heights[1]) == Approx(3 * std::stod(heights[0])).margin(0.1));
  CHECK(std::stod(heights[2]) == Approx(2 * std::stod(heights[0])).margin(0.1));
  CHECK(std::stod(heights[3]) == Approx(4 * std::stod(heights[0])).margin(0.1));
  for (std::size_t i = 1; i < x.size(); ++i) CHECK(std::stod(x[i]) > std::stod(x[i - 1]));
  CHECK(svg.find("printed in full") == std::string::npos);
}
