#pragma once
/// \file processes.hpp  Signals that end this program, and the Python that makes its pages and runs its batches.

#include <array>
#include <csignal>
#include <string>
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

/// The file of the running program; still the same one after a new program has been put in its place.
inline constexpr const char* kProgramFile = "/proc/self/exe";

// Python, which makes the pages of `report` from the files of runs and batches, and runs `batch`.

/// A Python interpreter that has a module.
struct FoundPython {
  std::string found;  ///< empty if none has it
  std::string tried;  ///< those that have it not, in words
};

/// $QUADEDGE_PYTHON; where that is not set, the first of `venv/bin/python3` beside the program (scripts/run.sh and
/// scripts/test.sh make it) and `python3` on PATH that can import the module.
FoundPython find_python(const std::string& module);

/// Starts `PYTHON -m quadedge.report ARGUMENTS`, without a shell, and waits for it. If no Python has the module, prints
/// one line on standard error on how to install it. Returns the module's exit code; ExitCode::usage where it is
/// missing. After a signal, ends PYTHON, then this process.
int make_page(const std::vector<std::string>& arguments, const Interruption& interruption);

/// Replaces this program by Python in this process. \throws UsageError when it cannot be started.
[[noreturn]] void become(const std::string& python, const std::vector<std::string>& arguments);

}  // namespace quadedge::cli
