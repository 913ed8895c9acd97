#pragma once
/// \file matching_html.hpp  The report of `evaluate matching` for people: tables, plots and drawings on one page.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"
#include "quadedge/device.hpp"

namespace quadedge::report {

/// What the page says about its making.
struct MatchingReportFacts {
  DeviceInfo device;
  Config config;  ///< as given; 0 for the maximum disparity means each data set's own
  evaluation::MatchingTolerance tolerance;
};

/// A page that needs nothing but itself, below 5 MB. Frames to be drawn are taken from MatchingResult::drawn.
std::string matching_html(const std::vector<evaluation::MatchingResult>& results, const MatchingReportFacts& facts);

}  // namespace quadedge::report
