#pragma once
/// \file matching_html_tables.hpp  The tables of `evaluate matching` for a page.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"
#include "report/html_page.hpp"

namespace quadedge::report {

/// One line per pair or sequence, and all of them pooled where there are several.
HtmlTable overview_table(const std::vector<evaluation::MatchingResult>& results,
                         const evaluation::MatchingSummary& pooled);
/// Table 1 or 2.
HtmlTable filter_table(const std::string& caption, const std::vector<evaluation::PooledRow>& rows);
/// Edges, stereo edges, pairs in time and quads over the frames.
HtmlTable count_table(const std::vector<evaluation::MatchingResult>& results);
/// Errors of the final stereo edges, and what the truth says about the left edges.
HtmlTable disparity_table(const evaluation::MatchingSummary& summary);
HtmlTable quad_table(const evaluation::MatchingSummary& summary);
/// Table 3.
HtmlTable constraint_table(const evaluation::MatchingSummary& summary);

/// A number with as many digits as it takes, or a dash where it does not exist.
std::string axis_text(double value);

}  // namespace quadedge::report
