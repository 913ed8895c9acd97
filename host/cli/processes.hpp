#pragma once
/// \file processes.hpp  Signals that end this program, this program as a child process, and the Python that makes
/// its pages.

#include <array>
#include <csignal>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace quadedge::cli {

// Ctrl-C and signals to end, which commands look for between their steps.

/// While it lives, SIGINT, SIGTERM and SIGHUP are noted instead of ending the process, each once: the second Ctrl-C
/// ends it at once. (Those that are ignored, as under nohup, stay ignored.) One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The signal received; 0: none.
  int signal() const;
  /// Ends this process by the signal received, so that its parent sees why.
  [[noreturn]] void end_process() const;

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};
};

// This program as a child process: one sequence of a batch.

/// How a process ended.
struct ChildEnd {
  int exit_code = 0;
  int signal = 0;  ///< that ended it; 0: it ended by itself
};

/// A running child. It does not outlive this process: the kernel kills it when this process dies, however that happens.
class ChildProcess {
 public:
  /// Starts this program with `arguments`; its standard output and error go to the new file `log`, and the error that
  /// it ends with, if any, to `error`.
  /// \throws DataError when the log cannot be made, Error when no process can be started.
  ChildProcess(const std::vector<std::string>& arguments, const std::string& log, const std::string& error);
  /// Kills the child if it still runs.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  /// How it ended, or nothing while it runs.
  std::optional<ChildEnd> ended();
  /// Asks it to end.
  void terminate() const;

 private:
  pid_t process_ = -1;  ///< -1 once it is reaped
};

/// The file of the running program; still the same one after a new program has been put in its place.
inline constexpr const char* kProgramFile = "/proc/self/exe";

// The pages of `report` and `batch`, which the Python module quadedge.report makes from the files
// that these commands write.

/// Starts `PYTHON -m quadedge.report ARGUMENTS`, without a shell, and waits for it. PYTHON is $QUADEDGE_PYTHON; where
/// that is not set, the first of `venv/bin/python3` beside the program (scripts/run.sh and scripts/test.sh make it) and
/// `python3` on PATH that has the module. If none has it, prints one line on standard error on how to install it.
/// Returns the module's exit code; ExitCode::usage where it is missing. After a signal, ends PYTHON, then this process.
int make_page(const std::vector<std::string>& arguments, const Interruption& interruption);

}  // namespace quadedge::cli
