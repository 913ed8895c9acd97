/// \file error.cpp  Escapes control characters of messages (C0, DEL, C1); names of warnings.
#include "quadedge/error.hpp"

#include "common/printed.hpp"

namespace quadedge {

std::string visible(const std::string& text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    const bool is_c1 = byte == 0xC2 && next >= 0x80 && next < 0xA0;  // U+0080 to U+009F in UTF-8
    if ((byte >= 0x20 || byte == '\n') && byte != 0x7F && !is_c1) {
      shown += text[i];
      continue;
    }
    shown += printed("\\x%02x", is_c1 ? next : byte);
    i += is_c1 ? 1 : 0;
  }
  return shown;
}

const char* to_string(WarningKind kind) {
  switch (kind) {
    case WarningKind::device_memory: return "device_memory";
    case WarningKind::implausible_calibration: return "implausible_calibration";
    case WarningKind::doubtful_calibration: return "doubtful_calibration";
    case WarningKind::small_disparity_range: return "small_disparity_range";
    case WarningKind::unsynchronised_cameras: return "unsynchronised_cameras";
    case WarningKind::unknown_motion: return "unknown_motion";
    case WarningKind::repeated_images: return "repeated_images";
    case WarningKind::large_disparity_offset: return "large_disparity_offset";
    case WarningKind::static_region: return "static_region";
    case WarningKind::displaced_images: return "displaced_images";
    case WarningKind::changed_rig: return "changed_rig";
    case WarningKind::poor_images: return "poor_images";
    case WarningKind::doubtful_lenses: return "doubtful_lenses";
  }
  return "unknown";
}

}  // namespace quadedge
