#pragma once
/// \file child_process.hpp  This program as a child process: one sequence of a batch.

#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace quadedge::cli {

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

}  // namespace quadedge::cli
