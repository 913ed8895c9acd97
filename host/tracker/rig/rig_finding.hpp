#pragma once
/// \file rig_finding.hpp  What can be wrong with a rig: found, and said, where it is looked for.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "quadedge/rig_evidence.hpp"
#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// What was measured and the likely cause, in one sentence for the user.
struct RigFinding {
  Warning warning;
  bool is_mismatch = false;  ///< whether a frame with it has no pose; the kind of the warning then says nothing
};

/// What was measured in a frame, and what is wrong with it.
struct RigReport {
  RigEvidence evidence;
  /// Patches around stereo edges; null without, valid until the next frame is judged.
  const std::vector<CornerMatch>* matches = nullptr;
  std::vector<RigFinding> findings;  ///< a mismatch is the first one
  /// What to hide of the left image from the next frame on; empty: nothing more, as what was hidden moves.
  std::optional<PixelMask> new_mask;

  /// The reason why the frame cannot be used, or null.
  const RigFinding* mismatch() const {
    return !findings.empty() && findings.front().is_mismatch ? &findings.front() : nullptr;
  }
};

/// What mends what a finding doubts.
inline constexpr const char* kMends = " `quadedge calibrate` learns the calibration from a drive";

/// "left" or "right".
std::string name(Side side);
/// A ratio, for messages.
std::string percent(double ratio);

/// Implausible numbers of a calibration: a baseline outside 5 mm to 5 m, a focal length outside 0.2 to 20 image widths,
/// a ratio of fx to fy outside 1 / 1.5 to 1.5, a principal point outside the image.
std::vector<RigFinding> implausible_numbers(const StereoRig& rig);

/// Reports a disparity offset [px] beyond what rectification leaves, in either direction. One that a motion alone
/// shows, without what was known before, counts where what is learned has left its prior in the same direction: a view
/// of a single plane shows none, and its motion any.
/// \param free of a motion alone \param sigma standard deviation of the prior; 0: none is learned
std::optional<RigFinding> judge_disparity_offset(double learned, double free = 0, double sigma = 0);

}  // namespace quadedge::rig
