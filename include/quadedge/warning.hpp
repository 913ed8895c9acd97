#pragma once
/// \file warning.hpp  Warnings that concern a whole recording.

#include <string>

namespace quadedge {

/// What a warning is about.
enum class WarningKind {
  device_memory,            ///< the device's memory holds fewer edges than configured
  implausible_calibration,  ///< an unusual baseline, focal length, pixel shape or principal point
  doubtful_calibration,     ///< corners lie beside their epipolar lines
  small_disparity_range,    ///< corners have disparities beyond the range searched
  negative_disparities,     ///< corners have negative disparities
  unsynchronised_cameras,   ///< the cameras seem to record at different times
  unknown_motion,           ///< the motion between two tracked frames is unknown; a new segment starts
  repeated_images,          ///< both images are those of the previous frame, byte for byte
  large_disparity_offset,   ///< the disparities have a larger common offset than rectification leaves
  static_region,            ///< a part of the image does not move while the rest does, such as a vehicle's bonnet
};
/// The name of the enumerator.
const char* to_string(WarningKind kind);

/// A warning about the recording, its calibration or the device.
struct Warning {
  WarningKind kind;
  std::string text;  ///< one sentence for the user
};

}  // namespace quadedge
