/// \file rig_maps.cpp  A cell keeps every n-th sample; when full, it drops half of them and doubles n.
#include "output/rig_maps.hpp"

#include <cmath>

#include "data/text.hpp"
#include "output/rows.hpp"
#include "output/statistics.hpp"

namespace quadedge::report {
namespace {

constexpr int kFewest = 20;            // samples of a median
constexpr std::size_t kMost = 1024;    // samples that a cell keeps
constexpr double kOfMedian = 1.2533;   // standard deviation of a median of n over that of a sample / sqrt(n)
constexpr double kDeviation = 1.4826;  // standard deviation of normal errors over their median magnitude

std::string field(double value) { return std::isfinite(value) ? data::format_exact(value) : std::string(); }

}  // namespace

void CellMap::add(double u, double v, double value) {
  if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return;
  Cell& cell =
      cells_[static_cast<std::size_t>(static_cast<int>(v * kRows) * kColumns + static_cast<int>(u * kColumns))];
  if (cell.seen++ % cell.every != 0) return;
  cell.values.push_back(static_cast<float>(value));
  if (cell.values.size() < kMost) return;
  for (std::size_t i = 0; 2 * i < kMost; ++i) cell.values[i] = cell.values[2 * i];
  cell.values.resize(kMost / 2);
  cell.every *= 2;
}

double CellMap::median(int column, int row) const {
  const Cell& of = cell(column, row);
  return of.seen < kFewest ? kNan : report::median({of.values.begin(), of.values.end()});
}

CellMap::Summary CellMap::summary() const {
  Summary summary;
  std::vector<double> deviations;
  double squares = 0, variances = 0, largest = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double middle = median(column, row);
      if (!std::isfinite(middle)) continue;
      ++summary.cells;
      squares += middle * middle;
      variances += 1.0 / static_cast<double>(cell(column, row).values.size());
      if (std::abs(middle) > std::abs(largest)) largest = middle;
      for (const float value : cell(column, row).values)
        deviations.push_back(std::abs(static_cast<double>(value) - middle));
    }
  }
  if (summary.cells == 0) return summary;
  summary.largest = largest;
  summary.rms = std::sqrt(squares / summary.cells);
  summary.scatter = kDeviation * upper_median(deviations);
  summary.noise = kOfMedian * summary.scatter * std::sqrt(variances / summary.cells);
  return summary;
}

std::string rig_maps_csv(const RigMaps& maps) {
  std::string text;
  for (int row = 0; row < CellMap::kRows; ++row) {
    for (int column = 0; column < CellMap::kColumns; ++column) {
      CsvRow line;
      line.add("column", column);
      line.add("row", row);
      line.add("x", field((column + 0.5) / CellMap::kColumns * maps.width - 0.5));
      line.add("y", field((row + 0.5) / CellMap::kRows * maps.height - 0.5));
      line.add("rows_before", field(maps.rows_before.median(column, row)));
      line.add("rows_after", field(maps.rows_after.median(column, row)));
      line.add("rows_samples", maps.rows_after.samples(column, row));
      line.add("columns_before", field(maps.columns_before.median(column, row)));
      line.add("columns_after", field(maps.columns_after.median(column, row)));
      line.add("columns_samples", maps.columns_after.samples(column, row));
      text += (text.empty() ? line.heading() : "") + line.line();
    }
  }
  return text;
}

}  // namespace quadedge::report
