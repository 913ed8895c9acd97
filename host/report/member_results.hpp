#pragma once
/// \file member_results.hpp  The results of one sequence of a batch: how it ended (member.json) and what its files say.

#include <optional>
#include <string>

#include "quadedge/evaluation.hpp"
#include "report/run_record.hpp"

namespace quadedge::report {

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

}  // namespace quadedge::report
