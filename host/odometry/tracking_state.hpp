#pragma once
/// \file tracking_state.hpp  What is known when the next frame comes: the rigs that it may be located against.

#include <Eigen/Geometry>
#include <optional>
#include <utility>

#include "frontend/rig.hpp"
#include "odometry/key_rig.hpp"
#include "pose/pose_covariance.hpp"
#include "pose/relative_pose.hpp"

namespace quadedge::odometry {

/// The rig that the next frame is matched with: that of the last frame with a pose. It may be the key rig.
struct BaseRig {
  frontend::RigHandle rig;      ///< null before the first frame with edges
  pose::RelativePose from_key;  ///< base_from_key, left cameras
  pose::UncertainPose in_key;   ///< the same motion as key_from_base
};

/// The newest frame that has edges and whose pose was not found.
struct LostRig {
  frontend::RigHandle rig;
  Eigen::Isometry3d world_from_left;  ///< predicted
};

/// Holds the rigs that later frames need; letting go of one gives its memory back to the front end.
struct TrackingState {
  BaseRig base;
  KeyRig key;
  std::optional<LostRig> lost;  ///< since the last frame with a pose; then the base is the key rig
  Eigen::Isometry3d world_from_last = Eigen::Isometry3d::Identity();  ///< last frame's pose, found or predicted

  bool has_started() const { return base.rig != nullptr; }
  bool base_is_key() const { return base.rig == key.rig(); }
  pose::UncertainPose world_from_base() const { return key.pose() * base.in_key; }

  /// A rig becomes key rig and base.
  void set_key(frontend::RigHandle rig, const pose::UncertainPose& pose, PoseOrigin origin = PoseOrigin::found) {
    key = KeyRig(rig, pose, origin);
    base = {std::move(rig), {}, {}};
  }
};

}  // namespace quadedge::odometry
