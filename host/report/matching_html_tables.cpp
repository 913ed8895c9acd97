#include "report/matching_html_tables.hpp"

#include <cmath>
#include <cstdio>

#include "report/canvas.hpp"
#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

using evaluation::FilterCounts;
using evaluation::FilterSpread;
using evaluation::MatchingSummary;

const std::string kPlusMinus = " \u00b1 ";

std::string decimal(double value, int decimals) { return std::isfinite(value) ? fixed(value, decimals) : "-"; }
std::string percent(double share, int decimals = 2) { return decimal(100 * share, decimals); }
std::string percent_with(double share, double deviation) {
  const int decimals = share < 0.0005 ? 4 : 2;
  return percent(share, decimals) + (std::isfinite(deviation) ? kPlusMinus + percent(deviation, decimals) : "");
}
double ratio(std::int64_t part, std::int64_t whole) { return static_cast<double>(part) / static_cast<double>(whole); }

/// 48299 as "48 299".
std::string count(std::int64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t position = digits.size(); position > 3 + (value < 0 ? 1U : 0U);) {
    position -= 3;
    digits.insert(position, "\u202f");
  }
  return digits;
}

void add_counts(const FilterCounts& counts, const FilterSpread& spread, std::vector<std::string>& cells) {
  cells.push_back(percent_with(counts.recall(), spread.recall));
  cells.push_back(percent_with(counts.precision(), spread.precision));
  cells.push_back(decimal(counts.ambiguity_mean(), 3));
  cells.push_back(decimal(counts.ambiguity_max(), 0));
}

std::vector<std::string> overview_row(const std::string& name, const MatchingSummary& summary) {
  std::vector<std::string> cells = {name, std::to_string(summary.frames), count(summary.census.edges)};
  for (const auto kind : summary.classes) cells.push_back(count(kind));
  const auto& last = summary.stereo.empty() ? evaluation::PooledRow{} : summary.stereo.back();
  for (const auto* counts : {&last.row.paired, &last.row.all}) {
    cells.push_back(percent(counts->recall()));
    cells.push_back(percent(counts->precision()));
  }
  cells.push_back(decimal(summary.disparity_median, 3));
  cells.push_back(percent(summary.quads_paired.counts.recall()));
  cells.push_back(percent(summary.quads_paired.counts.precision()));
  return cells;
}

}  // namespace

std::string axis_text(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

HtmlTable overview_table(const std::vector<evaluation::MatchingResult>& results, const MatchingSummary& pooled) {
  HtmlTable table;
  table.caption = "What is left at the end";
  table.groups = {{"", 3},
                  {"final stereo edges", 4},
                  {"stereo, paired [%]", 2},
                  {"stereo, all [%]", 2},
                  {"disparity, median", 1},
                  {"quads, paired [%]", 2}};
  table.columns = {"data",   "frames",    "left edges", "correct",   "inaccurate", "wrong",  "occluded",
                   "recall", "precision", "recall",     "precision", "error [px]", "recall", "precision"};
  for (const auto& result : results) table.rows.push_back(overview_row(result.name, evaluation::summarise({result})));
  if (results.size() > 1) {
    table.rows.push_back(overview_row("pooled", pooled));
    table.last_row_counts = true;
  }
  return table;
}

HtmlTable filter_table(const std::string& caption, const std::vector<evaluation::PooledRow>& rows) {
  HtmlTable table;
  table.caption = caption;
  if (rows.empty()) return table;
  const auto pool = [](const char* name, const FilterCounts& counts) { return name + count(counts.pool) + " edges"; };
  table.groups = {{"", 1}, {pool("paired: ", rows[0].row.paired), 4}, {pool("all: ", rows[0].row.all), 4}};
  table.columns = {"filter",     "recall [%]",    "precision [%]", "ambiguity", "max",
                   "recall [%]", "precision [%]", "ambiguity",     "max"};
  for (const auto& pooled : rows) {
    std::vector<std::string> cells = {std::to_string(pooled.row.order) + "  " + pooled.row.filter};
    add_counts(pooled.row.paired, pooled.paired_std, cells);
    add_counts(pooled.row.all, pooled.all_std, cells);
    table.rows.push_back(cells);
  }
  table.last_row_counts = true;
  return table;
}

HtmlTable count_table(const std::vector<evaluation::MatchingResult>& results) {
  struct Quantity {
    const char* name;
    int FrameCounts::*count;
    bool in_time;
  };
  constexpr Quantity kQuantities[] = {{"edges, left", &FrameCounts::edges_left, false},
                                      {"edges, right", &FrameCounts::edges_right, false},
                                      {"stereo edges", &FrameCounts::stereo_edges, false},
                                      {"with a match in time, left", &FrameCounts::temporal_left, true},
                                      {"with a match in time, right", &FrameCounts::temporal_right, true},
                                      {"quads", &FrameCounts::quads, true},
                                      {"inliers of the pose", &FrameCounts::inliers, true}};
  HtmlTable table;
  table.columns = {"per frame", "frames", "mean", "std", "min", "median", "max"};
  for (const auto& quantity : kQuantities) {
    std::vector<double> values;
    double sum = 0, squares = 0;
    for (const auto& result : results) {
      for (const auto& frame : result.frames) {
        if (quantity.in_time && frame.counts.temporal_left == 0) continue;
        values.push_back(frame.counts.*quantity.count);
        sum += values.back();
      }
    }
    if (values.empty()) continue;
    const double mean = sum / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
    const auto whole = [](double value) { return count(static_cast<std::int64_t>(std::lround(value))); };
    table.rows.push_back({quantity.name, std::to_string(values.size()), whole(mean),
                          values.size() > 1 ? whole(std::sqrt(squares / static_cast<double>(values.size()))) : "-",
                          whole(percentile(values, 0)), whole(median(values)), whole(percentile(values, 1))});
  }
  return table;
}

HtmlTable disparity_table(const MatchingSummary& summary) {
  HtmlTable table;
  table.caption = "Final stereo edges against the truth, and what the truth says about the left edges";
  table.groups = {{"disparity error [px]", 3}, {"part across the edge [px]", 2}, {"left edges", 5}};
  table.columns = {"median",   "90 %",         "bias",           "median",   "90 %",
                   "detected", "no statement", "along the line", "occluded", "on depth steps"};
  const auto& census = summary.census;
  table.rows = {{decimal(summary.disparity_median, 4), decimal(summary.disparity_p90, 4),
                 decimal(summary.disparity_bias, 4), decimal(summary.across_median, 4), decimal(summary.across_p90, 4),
                 count(census.edges), count(census.no_statement), count(census.along_line), count(census.occluded),
                 count(census.contour)}};
  return table;
}

HtmlTable quad_table(const MatchingSummary& summary) {
  HtmlTable table;
  table.caption = "Quads";
  table.columns = {"pool", "edges", "quads", "recall [%]", "precision [%]", "ambiguity"};
  const auto row = [](const std::string& name, const evaluation::PooledQuads& quads, const std::string& ambiguity) {
    return std::vector<std::string>{name,
                                    count(quads.counts.pool),
                                    count(quads.counts.candidates),
                                    percent_with(quads.counts.recall(), quads.std.recall),
                                    percent_with(quads.counts.precision(), quads.std.precision),
                                    ambiguity};
  };
  table.rows = {
      row("paired", summary.quads_paired,
          decimal(summary.quads_ambiguity_mean, 3) + kPlusMinus + decimal(summary.quads_paired.std.ambiguity, 3)),
      row("all", summary.quads_all, "")};
  return table;
}

HtmlTable constraint_table(const MatchingSummary& summary) {
  HtmlTable table;
  const auto& first = summary.constraints[0].counts;
  table.caption = "Table 3: pairs of quads after each constraint, " + count(first.pairs) + " pairs drawn";
  table.columns = {"constraint", "recall [%]", "precision [%]"};
  for (std::size_t order = 0; order < summary.constraints.size(); ++order) {
    const auto& row = summary.constraints[order];
    table.rows.push_back({std::to_string(order) + "  " + evaluation::kConstraintNames[order],
                          percent_with(ratio(row.counts.veridical, first.veridical), row.recall_std),
                          percent_with(ratio(row.counts.veridical, row.counts.pairs), row.precision_std)});
  }
  table.last_row_counts = true;
  return table;
}

}  // namespace quadedge::report
