#pragma once
/// \file matching_json.hpp  The machine-readable result of `evaluate matching` (doc/design.md section 10).

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"
#include "quadedge/device.hpp"
#include "report/drawing.hpp"

namespace quadedge::report {

/// Version of the document; incremented when a key changes its meaning.
constexpr int kMatchingSchema = 1;

/// Origin of the results.
struct MatchingFacts {
  std::string command;              ///< line that started the evaluation
  std::vector<std::string> inputs;  ///< as the command names them
  DeviceInfo device;
  Config config;  ///< as given; 0 for the maximum disparity means each data set's own
  evaluation::MatchingTolerance tolerance;
  std::vector<WrittenDrawing> drawings;
};

/// Text of a JSON document: `pairs` with one entry per pair or sequence, and `pooled` over all of them. Recall and
/// precision are fractions. `stereo`, `temporal_left`, `temporal_right` and `quads` are of the paired pool; the same
/// names with `_all` are of all edges of known truth. A row whose filter is switched off says `off`.
std::string matching_json(const std::vector<evaluation::MatchingResult>& results, const MatchingFacts& facts);

/// Spearman's rank correlation of the precision of the pairs that fulfil the constraints so far, and of the error of
/// the motions that they give; one point per frame and constraint. NaN where it does not exist.
struct MotionCorrelation {
  int points = 0;
  double rotation = 0, translation = 0;
};
MotionCorrelation motion_correlation(const std::vector<evaluation::MatchingResult>& results);

}  // namespace quadedge::report
