#pragma once
/// \file sequence_results.hpp  Everything that the report of a batch shows of one sequence.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/evaluation.hpp"
#include "quadedge/trajectory.hpp"
#include "report/batch_summary.hpp"
#include "report/frames_table.hpp"

namespace quadedge::report {

/// Another system: FOLDER holds NAME.txt, or NAME/trajectory.txt, per sequence (TUM format, left camera).
struct Peer {
  std::string name, folder;
};

/// One trajectory in the world of the plots: the first left camera that has ground truth, x right, y down, z forward
/// [m].
struct ComparedTrajectory {
  std::string name;
  Trajectory poses;
  std::optional<TrajectoryEvaluation> evaluation;  ///< against the ground truth, where there is one
  std::optional<SummaryAccuracy> accuracy() const;
};

/// One sequence of a batch with its comparisons.
struct SequenceResults {
  SummaryRow row;
  std::optional<SummaryRow> baseline;  ///< the same sequence in the other batch, if that ran
  std::vector<ComparedTrajectory>
      trajectories;  ///< this run, then the baseline's, then the peers that have one; empty if failed
  Trajectory truth;  ///< in the same world; empty without ground truth
  FramesTable frames;
  std::vector<std::string> thumbnails;  ///< files, in order of their frames
  std::vector<std::string> notes;       ///< peers that could not be compared, and why
  bool ran() const { return row.status == MemberStatus::done || row.status == MemberStatus::too_few_tracked; }
};

/// Reads the results of a sequence; where they are damaged it counts as failed. `baseline`: folder of the other batch,
/// or empty. What cannot be read of it or of a peer is said in the notes.
SequenceResults read_sequence_results(const std::string& output, const std::string& name, double min_tracked,
                                      const std::string& baseline, const std::vector<Peer>& peers);

}  // namespace quadedge::report
