#pragma once
/// \file odometry.hpp  Stereo visual odometry: stereo images in, poses out.

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/error.hpp"
#include "quadedge/image.hpp"
#include "quadedge/poses.hpp"
#include "quadedge/rig_estimate.hpp"
#include "quadedge/rig_evidence.hpp"

namespace quadedge {

/// Outcome of a frame.
enum class FrameStatus {
  first,               ///< the origin of the trajectory
  tracked,             ///< pose found against the keyframe or an earlier frame
  lost_too_few_edges,  ///< too few stereo edges in this frame
  lost_too_few_quads,  ///< too few quads with an earlier frame
  lost_no_consensus,   ///< no motion that enough of the image supports, or more than one
  lost_rig_mismatch,   ///< the images do not match the calibration
};
const char* to_string(FrameStatus status);
inline bool is_tracked(FrameStatus status) { return status == FrameStatus::first || status == FrameStatus::tracked; }

/// Counts of one frame; see doc/method.md sections 1 to 7.
struct FrameCounts {
  int edges_left = 0, edges_right = 0;
  int stereo_edges = 0;
  int temporal_left = 0, temporal_right = 0;  ///< previous stereo edges with a candidate in the left / right image
  int quads = 0;  ///< with the keyframe, or with the previous frame if the keyframe is out of view
  int inliers = 0;
};

/// Duration of one stage in one frame.
struct StageTime {
  std::string stage;
  double ms = 0;
};

/// Computing time of one frame.
struct FrameTiming {
  std::vector<StageTime> stages;   ///< on the host
  std::vector<StageTime> kernels;  ///< kernels of each stage, if the device profiles (DeviceOptions::profiling)
  double latency_ms = 0;           ///< from images in host memory to the pose on the host, steady clock
};

/// Internal quantities of one frame, for evaluation.
struct FrameDiagnostics {
  double edge_threshold = 0;   ///< gradient threshold of the edges in both images [grey levels per px]
  double disparity_range = 0;  ///< up to which stereo matches were searched for, in the middle of the left image [px]
  bool overflow = false;       ///< whether edges were dropped because a capacity was exceeded; see FrameResult::message
  /// Number of the frame that the pose was measured against: the keyframe or, if that is out of view, the last
  /// frame with a pose; -1 without a pose.
  int base_frame = -1;
  int search = -1;  ///< number of the frame's temporal search that gave its motion; -1: no motion
  /// Fraction of the edges in view that lie in image cells whose edges do not follow the camera's motion.
  double moving_ratio = 0;
  /// Number of image cells of 32 px (`pose.scoring_cell`) that move otherwise than the camera's motion has it, beyond
  /// the noise of the frame: information, no doubt about the pose.
  int moving_cells = 0;
  /// Bounds of the largest group of adjacent moving cells in the left image: left, top, right, bottom [px]; empty
  /// without any.
  std::optional<Eigen::Vector4d> moving_box;
  RigEvidence rig_evidence;
  /// Covariance of the pose in the reference's left camera frame, the inverse of current_from_reference, including
  /// calibration errors (`pose.rig_sigma_*`); empty for a lost frame.
  std::optional<PoseCovariance> covariance_in_reference;
  /// Sensitivity of that pose to calibration errors.
  RigSensitivity rig_sensitivity = RigSensitivity::Zero();
};

/// Result of one frame.
struct FrameResult {
  std::int64_t stamp_ns = 0;
  FrameStatus status = FrameStatus::first;
  /// Number of the frame's segment, from 0. Measurements connect all tracked frames of a segment with one another. If
  /// the motion across lost frames could not be measured, tracking resumes in a new segment. A lost frame has the
  /// number of the segment before it.
  int segment = 0;
  /// Pose of the left camera in the frame of the first left camera; empty for a lost frame. The poses of a new segment
  /// continue from a predicted pose: relative to one another they are measured, relative to other segments they are
  /// not.
  std::optional<Eigen::Isometry3d> world_from_left;
  /// Pose of a lost frame if the last motion is repeated; empty for any other frame.
  std::optional<Eigen::Isometry3d> predicted_world_from_left;
  /// Covariance of world_from_left, translation first as in ROS, within the segment: the pose that the segment starts
  /// from (the first frame; later, a predicted pose) counts as exact. Composed over the keyframes: edge errors
  /// are independent between rigs, calibration errors (`pose.rig_sigma_*`) are common to all. Empty for a lost frame.
  std::optional<PoseCovariance> covariance;
  /// Gamma_current = current_from_reference * Gamma_reference; the reference is the keyframe. Empty for a lost
  /// frame.
  std::optional<Eigen::Isometry3d> current_from_reference;
  /// Covariance of current_from_reference due to edge errors alone, in the order of PoseCovariance, as a left
  /// perturbation in the current left camera frame. Empty for a lost frame.
  std::optional<PoseCovariance> relative_covariance;
  int reference_frame = 0;   ///< number of the frame that was the keyframe; -1 before the first
  bool new_key_rig = false;  ///< whether this frame becomes the keyframe of the following frames
  /// With which the frame was measured; the disparity offset as estimated so far.
  RigEstimate rig;
  /// Another motion explains nearly as much of the image, or what moves may be the scene: see `message`.
  bool ambiguous_motion = false;
  FrameCounts counts;
  std::string message;  ///< empty, or one sentence for the user about this frame
  /// Warnings that concern the whole recording. Those of one kind are reported with the first frame that has any.
  std::vector<Warning> warnings;
  FrameTiming timing;
  FrameDiagnostics diagnostics;

  /// world_from_left or, for a lost frame, predicted_world_from_left; identity for a default-constructed result.
  Eigen::Isometry3d pose_or_prediction() const {
    return world_from_left.value_or(predicted_world_from_left.value_or(Eigen::Isometry3d::Identity()));
  }
};

/// Edges and quads of one frame, for drawing and for evaluation. Copied only on request.
struct FrameDetails {
  EdgeSet left_edges, right_edges;
  StereoEdges previous_stereo, stereo;    ///< of the frame that this one was matched with, if any, and of this frame
  TemporalMatches quads;                  ///< indices into previous_stereo and stereo
  std::vector<std::uint8_t> quad_inlier;  ///< one per quad
  RigEstimate previous_rig, rig;          ///< with which previous_stereo and stereo were measured
};

class Tap;

namespace odometry {
struct LatestFrame;
}

/// Tracks the camera through one sequence. Deterministic: identical frames, device and configuration give identical
/// bytes.
class StereoOdometry {
 public:
  /// Tracks on the device "auto": the first GPU, else the first CPU. Without a disparity range in the configuration the
  /// range follows the images, from StereoRig::disparity_range() on. \throws DataError for an unusable rig; UsageError
  /// for an invalid configuration; DeviceError if there is no device or kernels do not build.
  explicit StereoOdometry(const StereoRig& rig, const Config& config = {});
  /// The same on `device`, which must outlive the object.
  StereoOdometry(const StereoRig& rig, Device& device, const Config& config = {});
  ~StereoOdometry();

  /// Processes the next frame. Tracking failures are reported as a status. \throws DataError for images that do not fit
  /// the rig, a stride smaller than a row, or a timestamp earlier than the last one (the state does not change);
  /// DeviceError.
  FrameResult track(const StereoFrame& frame);

  /// Forgets all earlier frames, masks and warnings: the next frame may have any stamp, and starts a new segment at the
  /// last pose, which is no measurement. The rig's rows and disparity offset stay as learned. For clocks that were set,
  /// and recordings that were joined.
  void restart();

  /// Details of the frame tracked last, read back from the device; empty before the first frame.
  FrameDetails details() const;

  /// Stereo edges of the frame tracked last, valid until the next frame; none before the first frame.
  const StereoEdges& stereo_edges() const;

  /// The cameras that edge positions refer to: the rig passed to the constructor. If the resolution of one camera is at
  /// least one and a half times that of the other, that camera is reduced.
  const StereoRig& rig() const;
  /// The configuration in effect, including the disparity range.
  const Config& config() const;
  /// The device that it runs on.
  const DeviceInfo& device() const;

  /// Observes all filters in the following frames; null stops. A tap cannot change results.
  void set_tap(Tap* tap);

  /// Bytes allocated on the device.
  std::size_t device_bytes() const;
  /// Chosen kernel variant of each stage.
  std::map<std::string, std::string> variants() const;
  /// Time spent building programs [ms]; not what a driver generates where a kernel runs first.
  double kernel_build_ms() const;

 private:
  friend struct odometry::LatestFrame;
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
