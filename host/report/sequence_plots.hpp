#pragma once
/// \file sequence_plots.hpp  The plots of one sequence in the report of a batch.

#include <string>
#include <vector>

#include "report/sequence_results.hpp"

namespace quadedge::report {

/// All functions return finished SVG pictures. `points`: largest number of points of a curve; longer ones are thinned,
/// those over time so that their extremes stay.

/// The trajectory from above and from the side, with the ground truth and the other trajectories.
std::vector<std::string> trajectory_plots(const SequenceResults& results, int points);

/// Absolute and relative errors over time, origin-aligned; none without ground truth.
std::vector<std::string> error_plots(const SequenceResults& results, int points);

/// Counts and latencies over time, the latter as a stack of the stages.
std::vector<std::string> frame_plots(const SequenceResults& results, int points);

/// The curve with at most `limit` points (at least four): of every stretch its lowest and its highest value.
struct Curve {
  std::vector<double> xs, ys;
};
Curve thinned(const Curve& curve, int limit);

}  // namespace quadedge::report
