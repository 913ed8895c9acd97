#include "pose/rig_uncertainty.hpp"

namespace quadedge::pose {

RigSensitivity rig_sensitivity(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth) {
  const Eigen::Vector3d translation = fixed_from_camera.translation();
  const Eigen::Matrix3d turn = fixed_from_camera.linear();
  const Eigen::AngleAxisd rotation(turn);
  RigSensitivity result = RigSensitivity::Zero();
  result.col(0).head<3>() = translation;
  for (int axis = 0; axis < 3; ++axis) {
    // The motion in a frame that is rotated by w: exp(w) T exp(-w).
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    result.col(1 + axis).head<3>() = unit.cross(translation);
    result.col(1 + axis).tail<3>() = unit - turn * unit;
    result.col(5 + axis).tail<3>() = translation.norm() * inverse_depth * unit;
  }
  result.col(4).tail<3>() = rotation.angle() * rotation.axis();
  return result;
}

PoseCovariance rig_covariance(const RigSensitivity& by_rig, const PoseConfig& config) {
  Eigen::Matrix<double, kRigErrors, 1> sigma;
  sigma << config.rig_sigma_length, Eigen::Vector3d::Constant(config.rig_sigma_axis_rad()), config.rig_sigma_focal,
      Eigen::Vector3d::Constant(config.rig_sigma_lens);
  const RigSensitivity scaled = by_rig * sigma.asDiagonal();
  return scaled * scaled.transpose();
}

PoseCovariance whole_covariance(const UncertainPose& pose, const PoseConfig& config) {
  return pose.covariance + rig_covariance(pose.by_rig, config);
}

}  // namespace quadedge::pose
