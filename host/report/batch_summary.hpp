#pragma once
/// \file batch_summary.hpp  The results of many sequences in one table, per sequence and over all.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/evaluation.hpp"
#include "report/member_results.hpp"

namespace quadedge::report {

/// A batch.
struct BatchSummary {
  std::vector<SummaryRow> rows;
  int frames = 0, tracked = 0;  ///< of the sequences that did not fail
  LatencySummary latency;  ///< over all frames but the first one of each sequence [ms]; `first` is the median of those
  /// Over all sequences with ground truth, every pose with the same weight (mean and standard deviation of all poses
  /// together).
  std::optional<TrajectoryEvaluation> pooled;
  /// The same figures averaged over the sequences, every sequence with the same weight.
  std::optional<TrajectoryEvaluation> average;
  /// Added by the command line: the command, its input and its configuration.
  std::string command, input;
  std::optional<Config> config;
  int exit_code = 0;       ///< the worst of all sequences
  double min_tracked = 0;  ///< share of the frames below which too few are tracked [percent]
};

/// Summarises the results in OUT/sequences/NAME.
BatchSummary summarise(const std::string& output, const std::vector<std::string>& names, double min_tracked);

/// The worse of two exit codes. From bad to worse: too few tracked frames, usage, data, device, internal error.
int worse_exit_code(int a, int b);

/// summary.json: all figures, unrounded.
std::string summary_json(const BatchSummary& summary);

/// What OUT/summary.json states about the batch.
struct SummarisedBatch {
  std::vector<std::string> names;  ///< of the sequences, in the order of the batch
  double min_tracked = 0;          ///< as summarise() got it [percent]
};
/// \throws DataError for a missing or damaged file.
SummarisedBatch summarised_batch(const std::string& output);

/// Figures over several sequences, every pose with the same weight; nothing without sequences.
std::optional<TrajectoryEvaluation> pooled_accuracy(const std::vector<const TrajectoryEvaluation*>& parts);

}  // namespace quadedge::report
