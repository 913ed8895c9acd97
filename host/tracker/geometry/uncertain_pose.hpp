#pragma once
/// \file uncertain_pose.hpp  Motions and poses with covariance, and the effect of calibration errors on them
/// (doc/method.md section 7).

#include <Eigen/Geometry>
#include <optional>

#include "quadedge/config.hpp"
#include "quadedge/poses.hpp"

namespace quadedge::pose {

/// `transform` is b_from_a [m]; `covariance` refers to a left perturbation in frame b: (rotation [rad^2], translation
/// [m^2]). The default is the exact identity.
struct RelativePose {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The matrix whose product with a vector is v x that vector.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Maps a left perturbation before `transform` (rotation, translation) to the perturbation after it.
Eigen::Matrix<double, 6, 6> adjoint(const Eigen::Isometry3d& transform);

/// c_from_a from c_from_b and b_from_a, with independent errors.
RelativePose operator*(const RelativePose& c_from_b, const RelativePose& b_from_a);

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

/// The covariance of a RelativePose, which has the rotation first, in the order of PoseCovariance, and back.
inline PoseCovariance in_other_order(const PoseCovariance& covariance) {
  PoseCovariance other;
  other << covariance.bottomRightCorner<3, 3>(), covariance.bottomLeftCorner<3, 3>(), covariance.topRightCorner<3, 3>(),
      covariance.topLeftCorner<3, 3>();
  return other;
}

/// Returns camera_from_fixed.
UncertainPose inverse(const UncertainPose& fixed_from_camera);

/// Sensitivity of a pose, found from edges at `inverse_depth` [1/m], to calibration errors: a longer baseline lengthens
/// the translation, a rotated optical frame rotates the motion, and residual distortion rotates the camera in
/// proportion to the motion of the image and, where it turns, moves it.
/// \param fixed_from_camera a single motion, between two frames or since a keyframe
RigSensitivity rig_sensitivity(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth);

/// The last column of the sensitivity of such a pose, not set by rig_sensitivity(). \param by_offset change of the
/// motion current_from_earlier by a standard deviation of the disparity offset: rotation, translation [rad, m]
Eigen::Matrix<double, 6, 1> offset_sensitivity(const Eigen::Isometry3d& fixed_from_camera,
                                               const Eigen::Matrix<double, 6, 1>& by_offset);

/// Standard deviations of the calibration errors, `pose.rig_sigma_*`, and 1 for the offset; the errors are independent
/// of each other.
Eigen::Matrix<double, kRigErrors, 1> rig_sigmas(const PoseConfig& config);

/// Covariance due to calibration errors.
PoseCovariance rig_covariance(const RigSensitivity& by_rig, const PoseConfig& config);

/// Covariance due to edge and calibration errors.
PoseCovariance whole_covariance(const UncertainPose& pose, const PoseConfig& config);

}  // namespace quadedge::pose
