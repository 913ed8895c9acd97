#pragma once
/// \file error.hpp  The errors that the library throws, and the exit code that each one means.

#include <stdexcept>
#include <string>

namespace quadedge {

/// Exit codes of the command line (doc/design.md section 9); every error class belongs to one of them.
enum class ExitCode : int {
  done = 0,
  internal = 1,
  usage = 2,
  data = 3,
  device = 4,
  too_few_tracked = 5,
};

/// Base of everything that the library throws on purpose.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode exit_code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// A configuration value or an option that makes no sense; names the key and the allowed range.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// Missing, unreadable or contradictory input or output files; names the file, what was found and what was expected.
class DataError : public Error {
 public:
  explicit DataError(const std::string& message) : Error(ExitCode::data, message) {}
};

/// No OpenCL device, a kernel that does not build, or a failing OpenCL call.
class DeviceError : public Error {
 public:
  explicit DeviceError(const std::string& message) : Error(ExitCode::device, message) {}
};

}  // namespace quadedge
