#pragma once
/// \file rig_uncertainty.hpp  Effect of calibration errors on poses (doc/method.md section 7).

#include <Eigen/Geometry>
#include <optional>

#include "pose/uncertain_pose.hpp"
#include "quadedge/config.hpp"
#include "quadedge/pose_covariance.hpp"

namespace quadedge::pose {

/// Sensitivity of a pose, found from edges at `inverse_depth` [1/m], to calibration errors: a longer baseline lengthens
/// the translation, a rotated optical frame rotates the motion, a longer focal length reduces the angles, and residual
/// distortion rotates the camera in proportion to its approach to the scene.
/// \param fixed_from_camera a single motion, between two frames or since a key rig
RigSensitivity rig_sensitivity(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth);

/// Covariance due to calibration errors, which are independent of each other and have the sizes `pose.rig_sigma_*`.
PoseCovariance rig_covariance(const RigSensitivity& by_rig, const PoseConfig& config);

/// Covariance due to edge and calibration errors.
PoseCovariance whole_covariance(const UncertainPose& pose, const PoseConfig& config);

}  // namespace quadedge::pose
