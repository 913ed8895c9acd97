#pragma once
/// \file rig_evidence.hpp  Checks whether a frame's images match the calibration (doc/method.md section 7).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "odometry/epipolar_probe.hpp"
#include "odometry/rig_findings.hpp"
#include "odometry/synchronisation.hpp"
#include "quadedge/config.hpp"
#include "quadedge/rig_evidence.hpp"

namespace quadedge::odometry {

/// Monitors the calibration from frame to frame. In every frame some hundred patches are aligned. The search around the
/// epipolar lines, which takes about ten times as long, is run only when needed: in the first frame with edges, if
/// fewer edges match or their distance from the lines has grown, while the calibration does not match, and
/// periodically.
class RigWatch {
 public:
  RigWatch(const StereoRig& rig, const Config& config);

  /// Checks the next frame. \param edges its stereo edges \param left_edges number of edges in its left image
  /// \param evidence receives the measured quantities
  RigFindings judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, RigEvidence& evidence);

  /// Adds the image motion of that frame's edges; returns a warning if one camera seems to lag.
  /// \param base_frame number of the frame of `base`, which `matches` refers to \param frame number of the current
  /// frame
  std::optional<Warning> observe_motion(const StereoEdges& base, int base_frame, const StereoEdges& now, int frame,
                                        const TemporalMatches& matches);

 private:
  /// Reports a camera whose image is identical to the previous one while the other camera's is not; empty if there is
  /// none.
  std::string find_frozen_camera(const StereoFrame& frame);
  bool needs_search(const RigEvidence& evidence) const;

  StereoRig rig_;
  EpipolarProbe probe_;
  Synchronisation synchronisation_;
  std::vector<CornerMatch> corner_matches_;  ///< of the last frame checked
  std::vector<int> sampled_;  ///< index in corner_matches_ of every stereo edge, or -1; kept between calls
  // Positions of the base's edges in the previous frame:
  int base_frame_ = -1, last_frame_ = -1;
  std::vector<float> last_x_, last_y_, next_x_, next_y_;
  std::optional<RigEvidence> searched_;  ///< of the last frame that was searched
  bool fits_ = true;                     ///< whether that search found a match with the calibration
  int frames_since_search_ = 0;
  std::optional<std::uint64_t> last_left_, last_right_;  ///< of the previous images
};

/// The same for a single frame without edges, as used by `quadedge check`.
RigFindings examine_frame(const StereoRig& rig, const StereoFrame& frame, double max_disparity, RigEvidence& evidence);

}  // namespace quadedge::odometry
