#pragma once
/// \file rig_uncertainty.hpp  What a wrong calibration does to poses (doc/method.md section 7).

#include <Eigen/Geometry>
#include <optional>

#include "pose/pose_covariance.hpp"
#include "quadedge/config.hpp"
#include "quadedge/pose_covariance.hpp"

namespace quadedge::pose {

/// How a pose found by edges at `inverse_depth` [1/m] errs with the rig: a longer baseline lengthens the way, a turned
/// optical frame turns the motion, a longer focal length shortens the angles, and what is left of the distortion turns
/// the camera as it comes nearer to what it sees.
/// \param fixed_from_camera a motion found in one piece, between two frames or since a key rig
RigSensitivity rig_sensitivity(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth);

/// Covariance by the rig's errors alone, independent of each other, of the sizes `pose.rig_sigma_*`.
PoseCovariance rig_covariance(const RigSensitivity& by_rig, const PoseConfig& config);

/// Covariance by edges and rig together; nothing for a pose that was only predicted.
std::optional<PoseCovariance> whole_covariance(const UncertainPose& pose, const PoseConfig& config);

}  // namespace quadedge::pose
