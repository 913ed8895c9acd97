#pragma once
/// \file console.hpp  Progress on stderr, tables on stdout.

#include <chrono>
#include <string>

#include "output/run_record.hpp"
#include "quadedge/evaluation.hpp"

namespace quadedge::cli {

/// What a long command is doing, on stderr: one updating line on a terminal, else a plain line every few seconds;
/// nothing with --quiet.
class StatusLine {
 public:
  explicit StatusLine(bool quiet);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  /// Whether to show the next text now. Always true for the `last` one.
  bool due(bool last = false) const;
  /// Shows a text, which the next one replaces on a terminal unless it is the `last`.
  void show(const std::string& text, bool last = false);

 private:
  void end_line();

  bool quiet_, terminal_, line_open_ = false;
  std::chrono::steady_clock::time_point shown_;
};

/// Progress of a command that counts its work.
class Progress {
 public:
  /// \param unit  what is counted, for the rate: "frames"
  explicit Progress(bool quiet, std::string unit = {})
      : status_(quiet), unit_(std::move(unit)), start_(std::chrono::steady_clock::now()), updated_(start_) {}
  /// `done` of `total` (0: unknown) are finished, which also gives rate and remaining time; `note` is appended to the
  /// numbers. A new `what` starts a new step, whose time begins with the end of the previous one.
  void update(const std::string& what, int done, int total, const std::string& note = "");

 private:
  StatusLine status_;
  std::string unit_, what_;
  std::chrono::steady_clock::time_point start_, updated_;
};

/// A number as printf() formats it, or a dash for one that does not exist.
std::string dashed(const char* format, double value);

/// The command line of this process as it was typed, the program itself named quadedge: results say it.
std::string command_line();

/// A sentence on stderr that the user should see, also with --quiet.
void note(const std::string& sentence);

/// Prints the error with which the program ends.
void print_error(const std::string& message);

/// The results of a run on stdout, and the command that shows them. `output` is the folder that holds its files.
void print_run(const report::RunRecord& run, const std::string& output);

/// The tables of an evaluation on stdout.
void print_evaluation(const TrajectoryEvaluation& evaluation);

}  // namespace quadedge::cli
