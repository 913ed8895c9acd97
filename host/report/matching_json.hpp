#pragma once
/// \file matching_json.hpp  The machine-readable result of `evaluate matching` (doc/design.md section 9).

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"

namespace quadedge::report {

/// Text of a JSON document: `pairs` with one entry per pair or sequence, and `pooled` over all of them. Recall and
/// precision are fractions. `stereo`, `temporal_left`, `temporal_right` and `quads` are of the paired pool; the same
/// names with `_all` are of all edges of known truth.
std::string matching_json(const std::vector<evaluation::MatchingResult>& results);

}  // namespace quadedge::report
