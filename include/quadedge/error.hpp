#pragma once
/// \file error.hpp  Exceptions thrown by the library, with their exit codes.

#include <stdexcept>
#include <string>

namespace quadedge {

/// Exit codes of the command line (doc/design.md section 9). Every exception class maps to one of them.
enum class ExitCode : int {
  done = 0,
  internal = 1,
  usage = 2,
  data = 3,
  device = 4,
  too_few_tracked = 5,
};

/// Base class of all exceptions that the library throws deliberately.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode exit_code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// An invalid configuration value or option; the message names the key and the allowed range.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// Missing, unreadable or contradictory input or output files; the message names the file, what was found and what was
/// expected.
class DataError : public Error {
 public:
  explicit DataError(const std::string& message) : Error(ExitCode::data, message) {}
};

/// No OpenCL device, a kernel that does not build, or a failed OpenCL call.
class DeviceError : public Error {
 public:
  explicit DeviceError(const std::string& message) : Error(ExitCode::device, message) {}
};

}  // namespace quadedge
