#pragma once
/// \file rig_monitor.hpp  Checks whether the images match the calibration (doc/method.md section 7).

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "quadedge/edges.hpp"
#include "rig_check/epipolar_probe.hpp"
#include "rig_check/rig_finding.hpp"
#include "rig_check/rig_judgement.hpp"
#include "rig_check/rig_sentences.hpp"
#include "rig_check/static_region.hpp"
#include "rig_check/synchronisation.hpp"

namespace quadedge::rig_check {

/// Monitors a rig from frame to frame. In every frame, some hundred patches are aligned. The search around the epipolar
/// lines, which takes about ten times as long, is run only when needed: in the first frame with edges, when fewer edges
/// match or their distance from the lines has grown, while the images do not match the calibration, and periodically.
class RigMonitor {
 public:
  explicit RigMonitor(const StereoRig& rig);

  /// Checks the next frame. May run beside anything that leaves the frame and its edges as they are.
  /// \param edges its stereo edges \param left_edges number of edges in its left image
  /// \param max_disparity up to which they were searched, in the middle of the left image [px]
  /// \param correction see RigEvidence::epipolar_correction
  RigReport judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, double max_disparity,
                  double correction = 0);

  /// Adds the image motion of the frame passed to judge() since the last one; reports a camera that seems to lag.
  std::optional<RigFinding> observe_motion(const Eigen::Isometry3d& current_from_last);

  /// Checks a single frame without edges, as `quadedge check` does. \param max_disparity of the cascade [px]
  static RigReport examine(const StereoRig& rig, const StereoFrame& frame, double max_disparity);

 private:
  /// Reports images that are identical to the previous ones: of one camera, or of both.
  std::optional<RigFinding> find_repeated_images(const StereoFrame& frame);
  bool needs_search(const RigEvidence& evidence) const;

  StereoRig rig_;
  EpipolarProbe probe_;
  Synchronisation synchronisation_;
  StaticRegionDetector static_region_;
  std::vector<CornerMatch> corner_matches_;  ///< of the last frame checked
  std::optional<RigEvidence> searched_;      ///< of the last frame that was searched
  bool fits_ = true;                         ///< whether that search found a match with the calibration
  int frames_since_search_ = 0;
  std::optional<std::uint64_t> last_left_, last_right_;  ///< fingerprints of the previous images
};

}  // namespace quadedge::rig_check
