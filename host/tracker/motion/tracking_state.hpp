#pragma once
/// \file tracking_state.hpp  State between frames: the velocity, the keyframe and the other rigs against which the next
/// frame may be located (paper section 6, doc/method.md section 7).

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "edges/frame_edges.hpp"
#include "geometry/uncertain_pose.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// From one frame to a later one.
struct TimeStep {
  int frames = 1;
  std::int64_t ns = 0;  ///< 0: the stamps say nothing

  static TimeStep between(const frontend::FrameEdges& earlier, const frontend::FrameEdges& later) {
    return {later.frame - earlier.frame, later.stamp_ns - earlier.stamp_ns};
  }
};

/// The motion per frame interval. Stamps tell how many intervals lie between two frames, so that a dropped frame counts
/// as one; where they say nothing, the frames are counted.
class ConstantVelocity {
 public:
  /// Sets the velocity from a motion over a step; its translation is divided evenly.
  void observe(const Eigen::Isometry3d& current_from_earlier, TimeStep step) {
    one_interval_ = divided(current_from_earlier, step.frames);
    interval_ns_ = static_cast<double>(step.ns) / step.frames;
  }
  /// Resets the velocity to unknown.
  void forget() { one_interval_ = std::nullopt; }

  /// Returns current_from_earlier over a step, or nothing if no velocity is known or the step is too long for it.
  std::optional<Eigen::Isometry3d> predict(TimeStep step) const;

 private:
  static Eigen::Isometry3d divided(const Eigen::Isometry3d& motion, double parts);

  std::optional<Eigen::Isometry3d> one_interval_;
  double interval_ns_ = 0;
};

/// Quality of the current frame's location relative to the keyframe.
struct KeyRigFitness {
  int quads = 0;  ///< with the keyframe
  double inlier_ratio = 1;
  double median_parallax = 0;  ///< [px], left image
  double rotation = 0;         ///< [rad], from the keyframe to the current one
  int frames = 0;              ///< since the keyframe
};

/// Median displacement of the quads in the left image [px]; 0 without quads.
/// \param distances a buffer that is kept between calls
double median_parallax(const StereoEdges& key, const TemporalMatches& quads, std::vector<double>& distances);

/// Whether the pose of a keyframe was measured or predicted.
enum class PoseOrigin { found, predicted };

/// A frame with a known world pose, and its initial number of quads.
class KeyRig {
 public:
  /// No keyframe.
  KeyRig() = default;
  KeyRig(frontend::FrameEdgesHandle frame_edges, pose::UncertainPose pose, PoseOrigin origin = PoseOrigin::found)
      : frame_edges_(std::move(frame_edges)), pose_(std::move(pose)), origin_(origin) {}

  const frontend::FrameEdgesHandle& frame_edges() const { return frame_edges_; }
  /// Frame number; -1 if there is none.
  int frame() const { return frame_edges_ ? frame_edges_->frame : -1; }
  const Eigen::Isometry3d& world_from_left() const { return pose_.fixed_from_camera; }
  /// World pose with covariance.
  const pose::UncertainPose& pose() const { return pose_; }

  /// Whether the current frame should become the keyframe, see doc/method.md section 7. The first frame sets the
  /// reference for the number of quads. A keyframe whose pose was predicted serves for one frame only.
  bool needs_replacement(const KeyRigFitness& fitness, const OdometryConfig& config);

 private:
  frontend::FrameEdgesHandle frame_edges_;
  pose::UncertainPose pose_;  ///< in the world
  PoseOrigin origin_ = PoseOrigin::found;
  int first_quads_ = -1;  ///< of the first frame located against it
};

/// The edges that the next frame is matched with: those of the last frame with a pose, which may be the keyframe's.
struct BaseFrame {
  frontend::FrameEdgesHandle frame_edges;  ///< null before the first frame with edges
  pose::RelativePose from_key;             ///< base_from_key, left cameras
  pose::UncertainPose in_key;              ///< the same motion, as key_from_base
};

/// The latest frame that has edges but no pose.
struct LostFrame {
  frontend::FrameEdgesHandle frame_edges;
  Eigen::Isometry3d world_from_left;  ///< predicted
};

/// Holds the edges that later frames need; releasing them returns their memory to the front end.
struct TrackingState {
  BaseFrame base;
  KeyRig key;
  std::optional<LostFrame> lost;  ///< set from a loss until the next frame with a pose; the base is then the keyframe
  int segment = 0;                ///< see FrameResult::segment
  Eigen::Isometry3d world_from_last = Eigen::Isometry3d::Identity();  ///< pose of the last frame, measured or predicted

  bool has_started() const { return base.frame_edges != nullptr; }
  bool base_is_key() const { return base.frame_edges == key.frame_edges(); }
  pose::UncertainPose world_from_base() const { return key.pose() * base.in_key; }

  /// Makes a frame the keyframe and the base.
  void set_key(frontend::FrameEdgesHandle frame_edges, const pose::UncertainPose& pose,
               PoseOrigin origin = PoseOrigin::found) {
    key = KeyRig(frame_edges, pose, origin);
    base = {std::move(frame_edges), {}, {}};
  }
};

}  // namespace quadedge::odometry
