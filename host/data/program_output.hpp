#pragma once
/// \file program_output.hpp  Another program as a source of data.

#include <string>
#include <sys/types.h>
#include <vector>

namespace quadedge::data {

/// A running program with an empty standard input. It is killed with this object; where this process dies without
/// destructors, it ends at its next output. A terminal's Ctrl-C does not reach it.
class ProgramOutput {
 public:
  /// Starts a program that is found as a shell finds it. \throws DataError with `needed_for` if it is not installed
  ProgramOutput(const std::vector<std::string>& command, const std::string& needed_for);
  ~ProgramOutput();
  ProgramOutput(const ProgramOutput&) = delete;
  ProgramOutput& operator=(const ProgramOutput&) = delete;

  /// Waits until something was appended to `output` or `messages`, or one of them ended. \returns false if both have
  bool wait();

  std::string output, messages;  ///< from standard output and standard error; taken out by whoever uses it

 private:
  pid_t process_ = -1;
  int pipes_[2] = {-1, -1};  ///< of output and messages; -1 once ended
};

}  // namespace quadedge::data
