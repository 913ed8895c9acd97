#pragma once
/// \file odometry.hpp  Stereo images in, poses out.

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "quadedge/pose_covariance.hpp"
#include "quadedge/rig_evidence.hpp"

namespace quadedge {

/// What happened to a frame.
enum class FrameStatus {
  first,               ///< the origin of the trajectory
  tracked,             ///< pose found against the key stereo rig or the frame before
  lost_too_few_edges,  ///< not enough stereo edges in this frame
  lost_too_few_quads,  ///< edges, but not enough quads with a frame before
  lost_no_consensus,   ///< quads, but no motion that enough of them share
  lost_rig_mismatch,   ///< the images do not belong to the calibration
};
const char* to_string(FrameStatus status);
inline bool is_tracked(FrameStatus status) { return status == FrameStatus::first || status == FrameStatus::tracked; }

/// Counts of one frame; doc/method.md sections 1 to 7.
struct FrameCounts {
  int edges_left = 0, edges_right = 0;
  int stereo_edges = 0;
  int temporal_left = 0,
      temporal_right = 0;  ///< previous stereo edges that keep a candidate in the left / right images
  int quads = 0;           ///< with the key stereo rig, or with the frame before where that one is out of sight
  int inliers = 0;
};

/// Time of one stage of one frame.
struct StageTime {
  std::string stage;
  double ms = 0;
};

/// The outcome of one frame.
struct FrameResult {
  std::int64_t stamp_ns = 0;
  FrameStatus status = FrameStatus::first;
  /// Pose of the left camera in the frame of the first left camera. For a lost frame: the last motion repeated.
  Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();
  /// Gamma_current = current_from_reference * Gamma_reference, reference = key stereo rig.
  Eigen::Isometry3d current_from_reference = Eigen::Isometry3d::Identity();
  /// Covariance of current_from_reference: (rotation [rad^2], translation [m^2]) as a left perturbation in the current
  /// left frame.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of the pose in the reference's left camera frame, the inverse of current_from_reference, with what the rig's
  /// calibration may have wrong (`pose.rig_sigma_*`); nothing for a lost frame.
  std::optional<PoseCovariance> covariance_in_reference;
  /// Of world_from_left, composed over the key stereo rigs: errors of the edges as independent from one to the next,
  /// those of the rig as the same; nothing for a lost frame, and from where tracking went on from a predicted pose.
  std::optional<PoseCovariance> covariance_in_world;
  /// How the pose in the reference's frame errs with the rig.
  RigSensitivity rig_sensitivity = RigSensitivity::Zero();
  double edge_threshold = 0;    ///< that the gradient of both images' edges exceeds [grey levels per px]
  double disparity_offset = 0;  ///< found so far, added to every disparity [px]
  int reference_frame = 0;      ///< number of the frame that was the key stereo rig; -1 before the first one
  /// Number of the frame that the pose was measured against: the key stereo rig or, where that one is out of sight, the
  /// last frame with a pose; -1 without a pose.
  int base_frame = -1;
  int search = -1;           ///< number of the frame's search in time that its motion was taken from; -1: no motion
  bool new_key_rig = false;  ///< this frame becomes the key stereo rig of the following ones
  bool overflow = false;     ///< a capacity ran out (edges or candidates); the message says which
  std::string message;       ///< empty, or one sentence for a person
  /// Empty, or what is doubtful about the whole recording; each doubt is told once per run.
  std::string warning;
  RigEvidence rig;
  /// Another motion than the one taken explains nearly as much of the image; which is the world's cannot be told.
  bool ambiguous_motion = false;
  /// Edges in view in cells of the image that move otherwise than the camera says, of all edges in view.
  double moving_ratio = 0;
  FrameCounts counts;
  std::vector<StageTime> stages;  ///< host-side stages always; device stages when the device profiles
  double latency_ms = 0;          ///< images in host memory to pose on the host, steady clock
};

/// What one frame was made of; for drawing and for evaluation. Copied only on request.
struct FrameDetails {
  EdgeSet left_edges, right_edges;
  StereoEdges previous_stereo, stereo;    ///< of the frame that this one was matched with, if any, and of this one
  TemporalMatches quads;                  ///< indices into previous_stereo and stereo
  std::vector<std::uint8_t> quad_inlier;  ///< one per quad
};

class Tap;

/// The odometry. One object per sequence; deterministic: the same frames, device and configuration give the same bytes.
class StereoOdometry {
 public:
  /// \throws DataError for an unusable rig, UsageError for a bad configuration, DeviceError when kernels do not build.
  StereoOdometry(const StereoRig& rig, Device& device, const Config& config);
  ~StereoOdometry();

  /// Processes the next frame. What can happen in any frame is a status; \throws DataError for images that do not fit
  /// the rig, a stride below a row's bytes, a stamp before the last one's (no trace is left); DeviceError.
  FrameResult track(const StereoFrame& frame);

  /// Details of the frame tracked last (reads back from the device); empty before the first one.
  FrameDetails details() const;

  /// Stereo edges of the frame tracked last, valid until the next one; none before the first frame.
  const StereoEdges& stereo_edges() const;

  /// The cameras whose pixels edges are given in: the rig of the constructor, or where one camera has at least one and
  /// a half times the other's resolution, with that one reduced.
  const StereoRig& rig() const;

  /// Observes all filters of the following frames; null stops. The tap cannot change anything.
  void set_tap(Tap* tap);

  /// Bytes allocated on the device.
  std::size_t device_bytes() const;
  /// Chosen kernel variant of every stage.
  std::map<std::string, std::string> variants() const;
  /// Time spent building kernels [ms].
  double kernel_build_ms() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
