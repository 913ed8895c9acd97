#include "quadedge/error.hpp"

namespace quadedge {

const char* to_string(WarningKind kind) {
  switch (kind) {
    case WarningKind::device_memory: return "device_memory";
    case WarningKind::implausible_calibration: return "implausible_calibration";
    case WarningKind::doubtful_calibration: return "doubtful_calibration";
    case WarningKind::small_disparity_range: return "small_disparity_range";
    case WarningKind::negative_disparities: return "negative_disparities";
    case WarningKind::unsynchronised_cameras: return "unsynchronised_cameras";
    case WarningKind::unknown_motion: return "unknown_motion";
    case WarningKind::repeated_images: return "repeated_images";
    case WarningKind::large_disparity_offset: return "large_disparity_offset";
    case WarningKind::static_region: return "static_region";
  }
  return "unknown";
}

}  // namespace quadedge
