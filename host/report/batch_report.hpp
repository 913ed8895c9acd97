#pragma once
/// \file batch_report.hpp  The HTML page of a batch.

#include <string>
#include <vector>

#include "report/sequence_results.hpp"

namespace quadedge::report {

/// The page never gets larger than this [bytes].
inline constexpr std::size_t kLargestReport = 5'000'000;

/// One self-contained page over the batch in `output`: tables over all sequences, and per sequence its trajectory,
/// errors, counts, latencies and a few pictures. `baseline` (may be empty) is another batch: each figure shows how much
/// it differs from that. Curves are thinned and pictures reduced as far as it takes for the page to stay below
/// kLargestReport. \throws DataError for missing or damaged results.
std::string batch_report_html(const std::string& output, const std::string& baseline, const std::vector<Peer>& peers);

}  // namespace quadedge::report
