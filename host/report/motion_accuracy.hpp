#pragma once
/// \file motion_accuracy.hpp  Does a higher precision of the pairs of quads give better motions (the paper's Figure 7)?

#include <vector>

#include "evaluation/matching_result.hpp"

namespace quadedge::report {

/// Spearman's rank correlation of the precision of the pairs that fulfil the constraints so far, and of the error of
/// the motions that they give; one point per frame and constraint. NaN where it does not exist.
struct MotionCorrelation {
  int points = 0;
  double rotation = 0, translation = 0;
};
MotionCorrelation motion_correlation(const std::vector<evaluation::MatchingResult>& results);

}  // namespace quadedge::report
