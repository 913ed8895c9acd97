#pragma once
/// \file uncertain_pose.hpp  Covariances of poses from covariances of motions (doc/method.md section 7).

#include <Eigen/Geometry>

#include "pose/relative_pose.hpp"
#include "quadedge/pose_covariance.hpp"

namespace quadedge::pose {

/// Pose of a camera in a fixed frame [m].
struct UncertainPose {
  Eigen::Isometry3d fixed_from_camera = Eigen::Isometry3d::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();  ///< due to edge errors
  RigSensitivity by_rig = RigSensitivity::Zero();
};

/// Pose of the current camera in the frame of an earlier one, from the motion current_from_earlier.
UncertainPose pose_in_earlier(const RelativePose& current_from_earlier);

/// world_from_current from world_from_key and key_from_current. Edge errors of the two are independent, calibration
/// errors are the same.
UncertainPose operator*(const UncertainPose& world_from_key, const UncertainPose& key_from_current);

/// Returns camera_from_fixed.
UncertainPose inverse(const UncertainPose& fixed_from_camera);

}  // namespace quadedge::pose
