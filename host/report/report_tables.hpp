#pragma once
/// \file report_tables.hpp  The tables over all sequences in the report of a batch.

#include <vector>

#include "report/html_page.hpp"
#include "report/sequence_results.hpp"

namespace quadedge::report {

/// Errors of all sequences with the columns of the paper's Table 4, in one alignment; peers below the sequence that
/// they belong to, then everything together. With a baseline, its difference stands beside each figure.
HtmlTable error_table(const std::vector<SequenceResults>& sequences, const std::vector<Peer>& peers,
                      PoseErrors SummaryAccuracy::*alignment, const std::string& caption);

/// Tracked frames, key stereo rigs and latencies of all sequences.
HtmlTable latency_table(const std::vector<SequenceResults>& sequences);

}  // namespace quadedge::report
