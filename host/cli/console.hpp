#pragma once
/// \file console.hpp  Progress on stderr and tables on stdout.

#include <chrono>
#include <string>

#include "quadedge/evaluation.hpp"
#include "report/run_record.hpp"

namespace quadedge::cli {

/// Progress of a long command: one updating line on a terminal, else a plain line every few seconds, or nothing.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// `done` of `total` are finished; `note` is a short text behind the numbers.
  void update(const std::string& what, int done, int total, const std::string& note = "");

 private:
  void end_line();

  bool quiet_, terminal_, line_open_ = false;
  std::chrono::steady_clock::time_point last_;
};

/// A sentence on stderr that the user should see; nothing with `quiet`.
void note(bool quiet, const std::string& sentence);

/// The results of a run on stdout. `output` is the folder that holds its files.
void print_run(const report::RunRecord& run, const std::string& output);

/// The tables of an evaluation on stdout.
void print_evaluation(const TrajectoryEvaluation& evaluation);

}  // namespace quadedge::cli
