#pragma once
/// \file tracking_state.hpp  State between frames: the rigs against which the next frame may be located.

#include <Eigen/Geometry>
#include <optional>
#include <utility>

#include "frontend/rig.hpp"
#include "odometry/key_rig.hpp"
#include "pose/relative_pose.hpp"
#include "pose/uncertain_pose.hpp"

namespace quadedge::odometry {

/// The rig that the next frame is matched with: that of the last frame with a pose, which may be the key rig.
struct BaseRig {
  frontend::RigHandle rig;      ///< null before the first frame with edges
  pose::RelativePose from_key;  ///< base_from_key, left cameras
  pose::UncertainPose in_key;   ///< the same motion, as key_from_base
};

/// The latest frame that has edges but no pose.
struct LostRig {
  frontend::RigHandle rig;
  Eigen::Isometry3d world_from_left;  ///< predicted
};

/// Holds the rigs that later frames need; releasing a rig returns its memory to the front end.
struct TrackingState {
  BaseRig base;
  KeyRig key;
  std::optional<LostRig> lost;  ///< set from a loss until the next frame with a pose; the base is then the key rig
  int segment = 0;              ///< see FrameResult::segment
  Eigen::Isometry3d world_from_last = Eigen::Isometry3d::Identity();  ///< pose of the last frame, measured or predicted

  bool has_started() const { return base.rig != nullptr; }
  bool base_is_key() const { return base.rig == key.rig(); }
  pose::UncertainPose world_from_base() const { return key.pose() * base.in_key; }

  /// Makes a rig the key rig and the base.
  void set_key(frontend::RigHandle rig, const pose::UncertainPose& pose, PoseOrigin origin = PoseOrigin::found) {
    key = KeyRig(rig, pose, origin);
    base = {std::move(rig), {}, {}};
  }
};

}  // namespace quadedge::odometry
