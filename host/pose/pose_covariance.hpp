#pragma once
/// \file pose_covariance.hpp  From the covariances of motions to those of poses (doc/method.md section 7).

#include <Eigen/Geometry>
#include <optional>

#include "pose/relative_pose.hpp"
#include "quadedge/pose_covariance.hpp"

namespace quadedge::pose {

/// A camera's pose in a fixed frame [m].
struct UncertainPose {
  Eigen::Isometry3d fixed_from_camera = Eigen::Isometry3d::Identity();
  /// By the errors of the edges. Nothing where no measurement connects the camera with the fixed frame, and the pose is
  /// a prediction.
  std::optional<PoseCovariance> covariance = PoseCovariance::Zero();
  RigSensitivity by_rig = RigSensitivity::Zero();
};

/// The current camera's pose in the frame of an earlier one, of the motion current_from_earlier.
UncertainPose pose_in_earlier(const RelativePose& current_from_earlier);

/// world_from_current of world_from_key and key_from_current: the edges' errors are taken as independent, those of the
/// rig are the same.
UncertainPose operator*(const UncertainPose& world_from_key, const UncertainPose& key_from_current);

/// camera_from_fixed.
UncertainPose inverse(const UncertainPose& fixed_from_camera);

}  // namespace quadedge::pose
