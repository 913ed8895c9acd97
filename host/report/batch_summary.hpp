#pragma once
/// \file batch_summary.hpp  The results of a batch: how each sequence ended (member.json), what its files say, and
/// all of them in one table.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/evaluation.hpp"
#include "report/run_record.hpp"

namespace quadedge::report {

// The results of one sequence of a batch: how it ended (member.json) and what its files say.

/// One sequence of a batch that was run, successfully or not.
struct MemberRecord {
  std::string name;    ///< in the batch
  std::string path;    ///< of the recording
  std::string format;  ///< layout; empty if none is recognised
  std::string key;  ///< fingerprint of input, configuration, device and program; empty where the input cannot be opened
  int exit_code = 0;    ///< of the run, see doc/reference.md; 1 if a signal ended it
  std::string message;  ///< why it failed; empty where it did not
  int jobs = 1;  ///< sequences that ran at the same time: with more than one, latencies are not those of a lone run
};

/// Text of member.json. It has no times, so that two runs of the same input give the same bytes.
std::string member_json(const MemberRecord& record);

/// Reads FOLDER/member.json; nothing if it is missing or damaged; the sequence then counts as not run.
std::optional<MemberRecord> read_member(const std::string& folder);

/// Folder of a sequence's results within a batch.
std::string member_folder(const std::string& output, const std::string& name);

/// How a sequence of a batch ended.
enum class MemberStatus { done, too_few_tracked, failed, missing };
const char* to_string(MemberStatus status);

/// What the table of a batch states about a sequence.
struct SummaryRow {
  MemberRecord member;
  MemberStatus status = MemberStatus::missing;
  int frames = 0, tracked = 0, key_rigs = 0, segments = 0;
  std::string device;
  LatencySummary latency;                        ///< [ms]; NaN where the run failed
  std::optional<TrajectoryEvaluation> accuracy;  ///< only with ground truth
};

/// Reads the results of one sequence from its folder. A run that tracked fewer frames than `min_tracked` percent counts
/// as too_few_tracked, one whose results are damaged as failed.
SummaryRow read_summary_row(const std::string& folder, const std::string& name, double min_tracked);

/// The row of a sequence whose results are damaged, with the reader's complaint.
SummaryRow damaged(SummaryRow row, const std::string& complaint);

/// \throws DataError, naming the file, when one of the files that a finished run leaves in `folder` is missing,
/// damaged, or truncated: poses, rows and report must describe the same frames.
void check_whole(const std::string& folder);

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
