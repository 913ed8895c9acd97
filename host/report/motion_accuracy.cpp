#include "report/motion_accuracy.hpp"

#include <cmath>

#include "report/statistics.hpp"

namespace quadedge::report {

MotionCorrelation motion_correlation(const std::vector<evaluation::MatchingResult>& results) {
  std::vector<double> precisions, rotations, translations;
  for (std::size_t order = 0; order < evaluation::kConstraintNames.size(); ++order) {
    for (const auto& result : results) {
      for (const auto& frame : result.frames) {
        if (!frame.temporal) continue;
        const auto& counts = frame.temporal->pairs.table[order];
        const auto& error = frame.temporal->pairs.accuracy[order];
        if (counts.pairs == 0 || !std::isfinite(error.rotation_deg)) continue;
        precisions.push_back(static_cast<double>(counts.veridical) / static_cast<double>(counts.pairs));
        rotations.push_back(error.rotation_deg);
        translations.push_back(error.translation_m);
      }
    }
  }
  return {static_cast<int>(precisions.size()), rank_correlation(precisions, rotations),
          rank_correlation(precisions, translations)};
}

}  // namespace quadedge::report
