#pragma once
/// \file matching_plots.hpp  The plots of `evaluate matching` as SVG: what the paper's Figures 2, 3, 5, 6 and 7 show.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"
#include "report/svg_plot.hpp"

namespace quadedge::report {

/// Width and height of small plots, four of which stand side by side [px].
inline constexpr int kSmallPlotWidth = 304, kSmallPlotHeight = 236;

/// A small plot with its labels.
Plot small_plot(const std::string& title, const std::string& x_label, const std::string& y_label);

/// Recall and precision after every filter, of both pools.
std::string filter_plot(const std::string& title, const std::vector<evaluation::PooledRow>& rows);

/// Density (over the range shown) and cumulative curve (over all values) of a cue for veridical and other pairs, with
/// the thresholds drawn in.
std::vector<std::string> cue_plots(const evaluation::CueDistribution& cue);

/// Signed disparity errors of the final stereo edges: density, and fraction of edges within an absolute error.
std::vector<std::string> disparity_error_plots(const std::vector<evaluation::MatchingResult>& results);

/// Edges, stereo edges, pairs in time and quads of every frame: one bar per frame, or how many frames have how many
/// where there are more frames than bars can show.
std::vector<std::string> count_plots(const std::vector<evaluation::MatchingResult>& results);

/// The precision of pairs of quads against the accuracy of the motions that they give, one point per frame and
/// constraint.
struct AccuracyPlots {
  std::vector<std::string> svgs;
  double rotation_correlation = 0, translation_correlation = 0;  ///< Spearman's, over all points; NaN without
  int points = 0;
};
AccuracyPlots accuracy_plots(const std::vector<evaluation::MatchingResult>& results);

}  // namespace quadedge::report
