#include "report/matching_plots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/plot_axis.hpp"
#include "report/statistics.hpp"
#include "report/svg_bars.hpp"
#include "report/svg_plot.hpp"

namespace quadedge::report {
namespace {

using evaluation::FrameMatching;
using evaluation::MatchingResult;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostBars = 24;  // frames that get a bar each
constexpr int kCountBins = 16;         // about

/// One chart of counts. `values[f]`: one entry per series, NaN: no value in this frame.
std::string count_chart(const std::string& title, const std::vector<std::string>& series,
                        const std::vector<std::string>& names, const std::vector<std::vector<double>>& values) {
  BarChart chart;
  chart.title = title;
  chart.width = 2 * kSmallPlotWidth;
  chart.height = 260;
  std::vector<std::size_t> frames;
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (std::size_t f = 0; f < values.size(); ++f) {
    if (std::isnan(values[f][0])) continue;
    frames.push_back(f);
    for (const double value : values[f]) smallest = std::min(smallest, value), largest = std::max(largest, value);
  }
  const auto column = [&](std::size_t s) {
    std::vector<double> result;
    for (const std::size_t f : frames) result.push_back(values[f][s]);
    return result;
  };
  if (frames.size() <= kMostBars) {
    chart.y_label = "count";
    for (const std::size_t f : frames) chart.categories.push_back(names[f]);
    for (std::size_t s = 0; s < series.size(); ++s) chart.add_series(series[s], column(s));
    return chart.svg();
  }
  chart.y_label = "frames";
  chart.x_label = "count (left end of a bin)";
  const auto ticks = PlotAxis(smallest, largest, false).ticks(kCountBins);
  const double width = std::max(1.0, ticks[1].value - ticks[0].value), first = std::floor(smallest / width) * width;
  const auto count = static_cast<std::size_t>((largest - first) / width) + 1;
  for (std::size_t bin = 0; bin < count; ++bin)
    chart.categories.push_back(axis_number(first + static_cast<double>(bin) * width, 0));
  for (std::size_t s = 0; s < series.size(); ++s) {
    std::vector<double> bins(count, 0);
    for (const double value : column(s)) ++bins[static_cast<std::size_t>((value - first) / width)];
    chart.add_series(series[s], bins);
  }
  return chart.svg();
}

}  // namespace

Plot small_plot(const std::string& title, const std::string& x_label, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = x_label;
  plot.y_label = y_label;
  plot.width = kSmallPlotWidth;
  plot.height = kSmallPlotHeight;
  return plot;
}

std::string filter_plot(const std::string& title, const std::vector<evaluation::PooledRow>& rows) {
  Plot plot;
  plot.title = title;
  plot.x_label = "filters applied";
  plot.y_label = "share [%]";
  plot.width = 410;
  plot.height = 270;
  plot.y_low = 0, plot.y_high = 102;
  std::vector<double> order, recall, precision, all_recall, all_precision;
  for (const auto& pooled : rows) {
    order.push_back(pooled.row.order);
    recall.push_back(100 * pooled.row.paired.recall());
    precision.push_back(100 * pooled.row.paired.precision());
    all_recall.push_back(100 * pooled.row.all.recall());
    all_precision.push_back(100 * pooled.row.all.precision());
  }
  plot.add_line("recall, paired", order, recall);
  plot.add_line("precision, paired", order, precision);
  plot.add_line("recall, all", order, all_recall, true);
  plot.add_line("precision, all", order, all_precision, true);
  return plot.svg();
}

std::vector<std::string> count_plots(const std::vector<MatchingResult>& results) {
  std::vector<std::string> names;
  std::vector<std::vector<double>> edges, stereo, temporal, quads;
  for (const auto& result : results) {
    for (std::size_t f = 0; f < result.frames.size(); ++f) {
      const FrameMatching& frame = result.frames[f];
      const std::string number = std::to_string(f);
      names.push_back(results.size() == 1         ? number
                      : result.frames.size() == 1 ? result.name
                                                  : result.name + " " + number);
      const bool in_time = frame.counts.temporal_left + frame.counts.temporal_right > 0;
      const auto counted = [&](int count) { return in_time ? static_cast<double>(count) : kNan; };
      edges.push_back({static_cast<double>(frame.counts.edges_left), static_cast<double>(frame.counts.edges_right)});
      stereo.push_back({static_cast<double>(frame.counts.stereo_edges)});
      temporal.push_back({counted(frame.counts.temporal_left), counted(frame.counts.temporal_right)});
      quads.push_back({counted(frame.counts.quads)});
    }
  }
  std::vector<std::string> plots = {count_chart("Edges", {"left", "right"}, names, edges),
                                    count_chart("Stereo edges", {""}, names, stereo)};
  if (std::any_of(quads.begin(), quads.end(), [](const auto& values) { return !std::isnan(values[0]); })) {
    plots.push_back(count_chart("Stereo edges with a match in time", {"in the left images", "in the right images"},
                                names, temporal));
    plots.push_back(count_chart("Quads", {""}, names, quads));
  }
  return plots;
}

AccuracyPlots accuracy_plots(const std::vector<MatchingResult>& results) {
  AccuracyPlots plots;
  Plot rotation = small_plot("Motion of single pairs: rotation", "precision of the pairs [%]", "median error [deg]");
  Plot translation =
      small_plot("Motion of single pairs: translation", "precision of the pairs [%]", "median error [mm]");
  Plot whole_rotation =
      small_plot("Motion of all quads: rotation", "precision of the pairs, all constraints [%]", "error [deg]");
  Plot whole_translation =
      small_plot("Motion of all quads: translation", "precision of the pairs, all constraints [%]", "error [mm]");
  for (auto* plot : {&rotation, &translation, &whole_rotation, &whole_translation}) plot->y_logarithmic = true;
  rotation.width = translation.width = 2 * kSmallPlotWidth;
  rotation.height = translation.height = 300;
  std::vector<double> precisions, rotations, translations, last_precision, frame_rotation, frame_translation;
  const std::size_t orders = evaluation::kConstraintNames.size();
  for (std::size_t order = 0; order < orders; ++order) {
    std::vector<double> x, degrees, millimetres;
    for (const auto& result : results) {
      for (const auto& frame : result.frames) {
        if (!frame.temporal) continue;
        const auto& counts = frame.temporal->pairs.table[order];
        const auto& error = frame.temporal->pairs.accuracy[order];
        if (counts.pairs == 0) continue;
        const double precision = 100 * static_cast<double>(counts.veridical) / static_cast<double>(counts.pairs);
        if (order + 1 == orders && frame.motion) {
          last_precision.push_back(precision);
          frame_rotation.push_back(frame.motion->rotation_deg);
          frame_translation.push_back(1000 * frame.motion->translation_m);
        }
        if (!std::isfinite(error.rotation_deg)) continue;
        x.push_back(precision);
        degrees.push_back(error.rotation_deg);
        millimetres.push_back(1000 * error.translation_m);
      }
    }
    const std::string name = std::to_string(order) + " " + evaluation::kConstraintNames[order];
    rotation.add_points(name, x, degrees);
    translation.add_points(name, x, millimetres);
    precisions.insert(precisions.end(), x.begin(), x.end());
    rotations.insert(rotations.end(), degrees.begin(), degrees.end());
    translations.insert(translations.end(), millimetres.begin(), millimetres.end());
  }
  plots.points = static_cast<int>(precisions.size());
  plots.rotation_correlation = rank_correlation(precisions, rotations);
  plots.translation_correlation = rank_correlation(precisions, translations);
  plots.svgs = {rotation.svg(), translation.svg()};
  if (!last_precision.empty()) {
    whole_rotation.add_points("one frame", last_precision, frame_rotation);
    whole_translation.add_points("one frame", last_precision, frame_translation);
    plots.svgs.push_back(whole_rotation.svg());
    plots.svgs.push_back(whole_translation.svg());
  }
  return plots;
}

}  // namespace quadedge::report
