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
#include "rig/image_delay.hpp"
#include "rig/rig_finding.hpp"
#include "rig/static_region.hpp"

namespace quadedge::rig {

/// Implausible numbers of a calibration: a baseline outside 5 mm to 5 m, a focal length outside 0.2 to 20 image widths,
/// a ratio of fx to fy outside 1 / 1.5 to 1.5, a principal point outside the image.
std::vector<RigFinding> implausible_numbers(const StereoRig& rig);

/// Reports a disparity offset [px] beyond what rectification leaves, in either direction. One that a motion alone
/// shows, without what was known before, counts where what is learned has left its prior in the same direction: a view
/// of a single plane shows none, and its motion any.
/// \param free of a motion alone \param sigma standard deviation of the prior; 0: none is learned
std::optional<RigFinding> judge_disparity_offset(double learned, double free = 0, double sigma = 0);

/// If the right camera lags by t frame intervals, it shows points where they were t intervals ago, so that their
/// distance from the epipolar line is proportional to the image motion across that line. Calibration errors also cause
/// distances, but the same in every frame. Linear least squares over all frames so far:
///   across = (a quadratic polynomial in u and v) - t motion.
class Synchronisation {
 public:
  /// \param u, v position in the left image, -1/2 to 1/2 \param across distance from the epipolar line [px]
  /// \param motion displacement across the line over the last frame interval [px]
  void add(double u, double v, double across, double motion);

  /// Lag of the right camera in frame intervals, negative if the left one lags; 0 if not significant or
  /// implausibly large.
  double time_offset_frames() const;

 private:
  using Terms = Eigen::Matrix<double, 7, 1>;
  Eigen::Matrix<double, 7, 7> normal_ = Eigen::Matrix<double, 7, 7>::Zero();
  Terms right_side_ = Terms::Zero();
  double squares_ = 0;
  int count_ = 0;
};

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
  void forget_motions() { synchronisation_ = {}; }

  /// Checks a single frame without edges, as `quadedge check` does. \param max_disparity of the cascade [px]
  static RigReport examine(const StereoRig& rig, const StereoFrame& frame, double max_disparity);

 private:
  /// Reports images that are identical to the previous ones: of one camera, or of both.
  std::optional<RigFinding> find_repeated_images(const StereoFrame& frame);
  bool needs_search(const RigEvidence& evidence) const;
  /// Drops negative disparities from the findings of a search unless they are more in the mean of several.
  void confirm_negative_disparities(RigReport& report);
  bool doubts_partners(const RigReport& report) const;
  void judge_delay(const StereoFrame& frame, double max_disparity, RigReport& report);

  const StereoRig& rig_;
  bool auto_mask_;
  CornerMatcher corner_matcher_;
  Synchronisation synchronisation_;
  StaticRegionDetector static_region_;
  ImageDelayFinder delays_;
  DelayRounds delay_rounds_;
  DelayVotes delay_votes_;
  std::optional<RigFinding> held_;           ///< distances from the lines, until neighbours in time were looked at
  std::vector<CornerMatch> corner_matches_;  ///< of the last frame checked
  std::optional<RigEvidence> searched_;      ///< of the last frame that was searched
  bool fits_ = true;                         ///< whether that search found a match with the calibration
  int frames_since_search_ = 0, frames_ = 0;
  int searches_ = 0;            ///< that found something
  double negative_ratios_ = 0;  ///< sum over these
  bool is_interlaced_ = false;
  std::optional<std::uint64_t> last_left_, last_right_;  ///< fingerprints of the previous images
};

}  // namespace quadedge::rig
