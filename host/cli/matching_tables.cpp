#include "cli/matching_tables.hpp"

#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "cli/console.hpp"

namespace quadedge::cli {
namespace {

using evaluation::FilterCounts;
using evaluation::PooledRow;

std::string decimal(double value, int decimals) {
  return dashed(("%." + std::to_string(decimals) + "f").c_str(), value);
}

/// A share in percent, or a dash where it does not exist.
std::string percent(double share, int decimals = 2) { return decimal(100 * share, decimals); }

/// A share that may be far below one percent.
std::string fine_percent(double share) { return percent(share, share < 0.0005 ? 4 : 2); }

void print_counts(const FilterCounts& counts, const evaluation::FilterSpread& spread) {
  std::printf(" | %7s +-%5s %7s +-%5s %8s %9s %9s %6s", percent(counts.recall()).c_str(),
              percent(spread.recall, 1).c_str(), fine_percent(counts.precision()).c_str(),
              percent(spread.precision, 1).c_str(), fine_percent(counts.precision_per_edge()).c_str(),
              decimal(counts.ambiguity_mean(), 3).c_str(), decimal(counts.ambiguity_of_pool(), 3).c_str(),
              decimal(counts.ambiguity_max(), 0).c_str());
}

void print_filters(const char* title, const std::vector<PooledRow>& rows) {
  if (rows.empty()) return;
  std::printf("\n%s\n%-29s | paired: %" PRId64 " edges%-*s | all: %" PRId64 " edges\n", title, "",
              rows[0].row.paired.pool, 44, "", rows[0].row.all.pool);
  std::printf("%-29s", "order filter");
  for (int pool = 0; pool < 2; ++pool)
    std::printf(" | %-15s %-15s %8s %9s %9s %6s", " recall %", "precision %", "per edge", "ambiguity", "of pool",
                "max");
  std::printf("\n");
  for (const auto& pooled : rows) {
    std::printf("%2d %-26s", pooled.row.order, pooled.row.filter.c_str());
    print_counts(pooled.row.paired, pooled.paired_std);
    print_counts(pooled.row.all, pooled.all_std);
    std::printf("\n");
  }
}

void print_constraints(const evaluation::MatchingSummary& summary) {
  const auto& table = summary.constraints;
  if (table[0].counts.pairs == 0) return;
  std::printf("\nTable 3: pairs of quads after each constraint, %" PRId64 " pairs drawn\n%-29s  %-15s  %-15s\n",
              table[0].counts.pairs, "order constraint", "  recall %", "precision %");
  for (std::size_t order = 0; order < table.size(); ++order) {
    const auto& row = table[order];
    std::printf(
        "%2zu %-26s  %7s +-%5s  %7s +-%5s\n", order, evaluation::kConstraintNames[order],
        percent(static_cast<double>(row.counts.veridical) / static_cast<double>(table[0].counts.veridical)).c_str(),
        percent(row.recall_std, 1).c_str(),
        percent(static_cast<double>(row.counts.veridical) / static_cast<double>(row.counts.pairs)).c_str(),
        percent(row.precision_std, 1).c_str());
  }
}

void print_quads(const char* pool, const evaluation::PooledQuads& quads) {
  std::printf("quads, %-7s recall %s +- %s %%, precision %s +- %s %% (%" PRId64 " edges, %" PRId64 " quads)\n", pool,
              percent(quads.counts.recall()).c_str(), percent(quads.std.recall, 1).c_str(),
              percent(quads.counts.precision()).c_str(), percent(quads.std.precision, 1).c_str(), quads.counts.pool,
              quads.counts.candidates);
}

const PooledRow* find(const std::vector<PooledRow>& rows, int order) {
  for (const auto& row : rows) {
    if (row.row.order == order) return &row;
  }
  return nullptr;
}

void print_sweep_row(const std::vector<PooledRow>& rows, int order) {
  const PooledRow* row = find(rows, order);
  if (row == nullptr) return;
  const FilterCounts &paired = row->row.paired, &all = row->row.all;
  std::printf(" | %7s %7s %8s %7s %7s", percent(paired.recall()).c_str(), percent(paired.precision()).c_str(),
              decimal(paired.ambiguity_mean(), 3).c_str(), percent(all.recall()).c_str(),
              percent(all.precision()).c_str());
}

void print_sweep_title(const char* table, const std::vector<PooledRow>& rows, int order) {
  const PooledRow* row = find(rows, order);
  if (row != nullptr)
    std::printf(" | %-40s", (std::string(table) + " " + std::to_string(order) + " " + row->row.filter).c_str());
}

/// Calls `print` for the chosen rows of all three tables.
template <class Print>
void for_rows(const evaluation::MatchingSummary& summary, const std::vector<int>& stereo_orders,
              const std::vector<int>& temporal_orders, const Print& print) {
  for (const int order : stereo_orders) print("stereo", summary.stereo, order);
  for (const int order : temporal_orders) {
    print("left", summary.temporal_left, order);
    print("right", summary.temporal_right, order);
  }
}

}  // namespace

void print_matching(const std::string& title, const evaluation::MatchingSummary& summary) {
  std::printf("\n=== %s: %d stereo frame%s ===\n", title.c_str(), summary.frames, summary.frames == 1 ? "" : "s");
  const auto& census = summary.census;
  std::printf("left edges %" PRId64 ": no statement about %" PRId64 ", along their epipolar line %" PRId64
              ", occluded %" PRId64 ", on depth steps %" PRId64 "\n",
              census.edges, census.no_statement, census.along_line, census.occluded, census.contour);
  print_filters("Table 1: stereo", summary.stereo);
  std::printf("final stereo edges: ");
  for (std::size_t kind = 0; kind < summary.classes.size(); ++kind) {
    std::printf("%s%" PRId64 " %s", kind == 0 ? "" : ", ", summary.classes[kind], evaluation::kMatchClassNames[kind]);
  }
  std::printf("\n");
  std::printf("disparity error: median %s px, p90 %s px, bias %s px; across the edge: median %s px, p90 %s px\n",
              decimal(summary.disparity_median, 4).c_str(), decimal(summary.disparity_p90, 4).c_str(),
              decimal(summary.disparity_bias, 4).c_str(), decimal(summary.across_median, 4).c_str(),
              decimal(summary.across_p90, 4).c_str());
  print_filters("Table 2: in time, left images", summary.temporal_left);
  print_filters("Table 2: in time, right images", summary.temporal_right);
  if (summary.temporal_frames > 0) {
    std::printf("\n");
    print_quads("paired:", summary.quads_paired);
    print_quads("all:", summary.quads_all);
    std::printf("quads, paired: ambiguity %s +- %s (further matches per quad)\n",
                decimal(summary.quads_paired.ambiguity_mean, 3).c_str(),
                decimal(summary.quads_paired.std.ambiguity, 3).c_str());
  }
  print_constraints(summary);
}

void print_sweep_heading(const std::string& key, const evaluation::MatchingSummary& summary,
                         const std::vector<int>& stereo_orders, const std::vector<int>& temporal_orders) {
  std::printf("%12s", "");
  for_rows(summary, stereo_orders, temporal_orders, print_sweep_title);
  std::printf("\n%12s", key.substr(key.find('.') + 1).substr(0, 12).c_str());
  for_rows(summary, stereo_orders, temporal_orders, [](const char*, const std::vector<PooledRow>& rows, int order) {
    if (find(rows, order) != nullptr)
      std::printf(" | %7s %7s %8s %7s %7s", "rec", "prec", "ambig", "rec.all", "prec.all");
  });
  std::printf("  quads rec  prec  prec.all  disp.med\n");
}

void print_sweep_line(double value, const evaluation::MatchingSummary& summary, const std::vector<int>& stereo_orders,
                      const std::vector<int>& temporal_orders) {
  std::printf("%12g", value);
  for_rows(summary, stereo_orders, temporal_orders,
           [](const char*, const std::vector<PooledRow>& rows, int order) { print_sweep_row(rows, order); });
  const FilterCounts& quads = summary.quads_paired.counts;
  std::printf("  %9s %5s %9s %9s\n", percent(quads.recall()).c_str(), percent(quads.precision()).c_str(),
              percent(summary.quads_all.counts.precision()).c_str(), decimal(summary.disparity_median, 4).c_str());
  std::fflush(stdout);
}

}  // namespace quadedge::cli
