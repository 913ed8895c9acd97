#pragma once
/// \file error.hpp  Exceptions thrown by the library, with their exit codes, and warnings.

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

/// A text for terminals: control characters other than line feeds are written as \xNN, so that words from a file cannot
/// act on the terminal that shows them.
std::string visible(const std::string& text);

/// Base class of all exceptions that the library throws deliberately.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(visible(message)), code_(code) {}
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

/// What a warning is about. What to do about each kind: python/quadedge/report/advice.py, which a test compares.
enum class WarningKind {
  device_memory,            ///< the device's memory holds fewer edges than configured
  implausible_calibration,  ///< an unusual baseline, focal length, pixel shape or principal point
  doubtful_calibration,     ///< corners lie beside their epipolar lines
  small_disparity_range,    ///< corners have disparities beyond the range searched
  unsynchronised_cameras,   ///< the cameras, or the rows of an image, seem to record at different times
  unknown_motion,           ///< the motion between two tracked frames is unknown; a new segment starts
  repeated_images,          ///< both images are those of the previous frame, byte for byte
  large_disparity_offset,   ///< the disparities have a larger common offset than rectification leaves
  static_region,            ///< a part of the image does not move while the rest does, such as a vehicle's bonnet
  displaced_images,         ///< single right images are displaced along the epipolar lines
  changed_rig,              ///< one of the cameras has turned since the recording began
  poor_images,              ///< saturated or unequally exposed images, or masks that hide most of one
  doubtful_lenses,          ///< the focal lengths or the distortion of both cameras seem to be wrong alike
};
/// The name of the enumerator.
const char* to_string(WarningKind kind);

/// A warning about the recording, its calibration or the device.
struct Warning {
  WarningKind kind;
  std::string text;  ///< one sentence for the user
};

}  // namespace quadedge
