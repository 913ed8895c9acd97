#pragma once
/// \file rig_monitor.hpp  Checks whether the images match the calibration (doc/method.md section 7).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/frame_mask.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/rig_estimate.hpp"
#include "rig/corner_matching.hpp"
#include "rig/rig_finding.hpp"
#include "rig/row_model.hpp"
#include "rig/static_region.hpp"

namespace quadedge::rig {

/// Monitors a rig from frame to frame. In every frame, some hundred patches are aligned. The search around the epipolar
/// lines, which takes about ten times as long, is run only when needed: in the first frame with edges, when fewer edges
/// match or their distance from the lines has grown, while the images do not match the calibration, and periodically.
class RigMonitor {
 public:
  /// \param rig must outlive the object \param auto_mask whether reports hold masks
  explicit RigMonitor(const StereoRig& rig, bool auto_mask = false);

  /// Checks the next frame. May run beside anything that leaves the frame and its edges as they are.
  /// \param edges its stereo edges \param left_edges number of edges in its left image
  /// \param max_disparity up to which they were searched, in the middle of the left image [px]
  /// \param rig as far as it is known from earlier frames \param hidden what the masks of the frame hide
  RigReport judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, double max_disparity,
                  const RigEstimate& rig = {}, const HiddenPixels& hidden = {});

  /// Adds the image motion of the frame passed to judge() since the last one; reports a camera that seems to lag.
  std::optional<RigFinding> observe_motion(const Eigen::Isometry3d& current_from_last);
  /// The distances from the lines that were seen so far are those of another rig.
  void forget_motions() { times_ = RowModel(rig_.left, kTimeMemory); }

  /// Checks a single frame without edges, as `quadedge check` does. \param max_disparity of the cascade [px]
  static RigReport examine(const StereoRig& rig, const StereoFrame& frame, double max_disparity);

 private:
  /// Reports images that are identical to the previous ones: of one camera, or of both.
  std::optional<RigFinding> find_repeated_images(const StereoFrame& frame);
  bool needs_search(const RigEvidence& evidence) const;
  /// Whether the images fit clearly worse than when they were searched last.
  bool has_worsened(const RigEvidence& evidence) const;
  bool doubts_time(const RigEvidence& evidence) const;
  void search(const StereoFrame& frame, double max_disparity, const RigEstimate& rig, const HiddenPixels& hidden,
              RigReport& report);
  void judge_time(const std::vector<CornerMatch>& found, RigReport& report);

  const StereoRig& rig_;
  bool auto_mask_;
  CornerMatcher corner_matcher_;
  RowModel times_;  ///< of matches with a motion
  StaticRegionDetector static_region_;
  std::vector<CornerMatch> corner_matches_;  ///< of the last frame checked
  std::optional<RigEvidence> searched_;      ///< of the last frame that was searched
  bool fits_ = true;                         ///< whether that search found a match with the calibration
  int frames_since_search_ = 0;
  GreyPlane last_view_;                                  ///< the left image of the last search
  int time_searches_ = 0;                                ///< in a row, for the time between the images
  std::optional<std::uint64_t> last_left_, last_right_;  ///< fingerprints of the previous images
};

}  // namespace quadedge::rig
