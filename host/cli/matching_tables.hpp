#pragma once
/// \file matching_tables.hpp  The tables of `evaluate matching` on stdout.

#include <string>

#include "evaluation/matching_result.hpp"

namespace quadedge::cli {

/// Tables 1 to 3, the quads and the disparity errors of one or several results.
void print_matching(const std::string& title, const evaluation::MatchingSummary& summary);

/// Heading of the lines that print_sweep_line prints; `filters`: the rows of the table that are shown.
void print_sweep_heading(const std::string& key, const evaluation::MatchingSummary& summary,
                         const std::vector<int>& stereo_orders, const std::vector<int>& temporal_orders);
/// Recall, precision and ambiguity of some rows for one value of a threshold.
void print_sweep_line(double value, const evaluation::MatchingSummary& summary, const std::vector<int>& stereo_orders,
                      const std::vector<int>& temporal_orders);

}  // namespace quadedge::cli
