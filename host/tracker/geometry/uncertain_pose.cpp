/// \file uncertain_pose.cpp  Carries covariances by adjoints; one column of sensitivity per error of the calibration.
#include "geometry/uncertain_pose.hpp"

namespace quadedge::pose {

Eigen::Matrix<double, 6, 6> adjoint(const Eigen::Isometry3d& transform) {
  Eigen::Matrix<double, 6, 6> result = Eigen::Matrix<double, 6, 6>::Zero();
  result.topLeftCorner<3, 3>() = transform.linear();
  result.bottomRightCorner<3, 3>() = transform.linear();
  result.bottomLeftCorner<3, 3>() = cross_matrix(transform.translation()) * transform.linear();
  return result;
}

RelativePose operator*(const RelativePose& c_from_b, const RelativePose& b_from_a) {
  const Eigen::Matrix<double, 6, 6> carried = adjoint(c_from_b.transform);
  return {c_from_b.transform * b_from_a.transform,
          c_from_b.covariance + carried * b_from_a.covariance * carried.transpose()};
}

UncertainPose pose_in_earlier(const RelativePose& current_from_earlier) {
  const Eigen::Isometry3d pose = current_from_earlier.transform.inverse();
  // If current_from_earlier is perturbed by (w, v), the error of the position is -R v and that of the rotation -R w,
  // with R of `pose`.
  PoseCovariance turned = PoseCovariance::Zero();  // from (rotation, translation) to (translation, rotation)
  turned.topRightCorner<3, 3>() = pose.linear();
  turned.bottomLeftCorner<3, 3>() = pose.linear();
  return {pose, turned * current_from_earlier.covariance * turned.transpose(), RigSensitivity::Zero()};
}

UncertainPose operator*(const UncertainPose& world_from_key, const UncertainPose& key_from_current) {
  UncertainPose result;
  result.fixed_from_camera = world_from_key.fixed_from_camera * key_from_current.fixed_from_camera;
  // A rotation error of the keyframe also displaces the current camera, by its distance from the keyframe.
  const Eigen::Matrix3d turn = world_from_key.fixed_from_camera.linear();
  const Eigen::Vector3d offset = turn * key_from_current.fixed_from_camera.translation();
  PoseCovariance carried = PoseCovariance::Identity(), turned = PoseCovariance::Zero();
  carried.topRightCorner<3, 3>() = -cross_matrix(offset);
  turned.topLeftCorner<3, 3>() = turn;
  turned.bottomRightCorner<3, 3>() = turn;
  result.by_rig = carried * world_from_key.by_rig + turned * key_from_current.by_rig;
  result.covariance = carried * world_from_key.covariance * carried.transpose() +
                      turned * key_from_current.covariance * turned.transpose();
  return result;
}

UncertainPose inverse(const UncertainPose& fixed_from_camera) {
  UncertainPose result;
  result.fixed_from_camera = fixed_from_camera.fixed_from_camera.inverse();
  const Eigen::Matrix3d back = result.fixed_from_camera.linear();
  PoseCovariance change = PoseCovariance::Zero();
  change.topLeftCorner<3, 3>() = change.bottomRightCorner<3, 3>() = -back;
  change.topRightCorner<3, 3>() = -back * cross_matrix(fixed_from_camera.fixed_from_camera.translation());
  result.by_rig = change * fixed_from_camera.by_rig;
  result.covariance = change * fixed_from_camera.covariance * change.transpose();
  return result;
}

RigSensitivity rig_sensitivity(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth) {
  const Eigen::Vector3d translation = fixed_from_camera.translation();
  const Eigen::Matrix3d turn = fixed_from_camera.linear();
  const Eigen::AngleAxisd rotation(turn);
  const double image_motion = translation.norm() * inverse_depth + rotation.angle();
  RigSensitivity result = RigSensitivity::Zero();
  result.col(0).head<3>() = translation;
  for (int axis = 0; axis < 3; ++axis) {
    // The motion in a frame that is rotated by w: exp(w) T exp(-w).
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    result.col(1 + axis).head<3>() = unit.cross(translation);
    result.col(1 + axis).tail<3>() = unit - turn * unit;
    result.col(4 + axis).tail<3>() = image_motion * unit;
    if (inverse_depth > 0) result.col(7 + axis).head<3>() = rotation.angle() / inverse_depth * unit;
  }
  return result;
}

Eigen::Matrix<double, 6, 1> offset_sensitivity(const Eigen::Isometry3d& fixed_from_camera,
                                               const Eigen::Matrix<double, 6, 1>& by_offset) {
  const Eigen::Matrix3d turn = fixed_from_camera.linear();
  Eigen::Matrix<double, 6, 1> result;
  result << -turn * by_offset.tail<3>(), -turn * by_offset.head<3>();
  return result;
}

Eigen::Matrix<double, kRigErrors, 1> rig_sigmas(const PoseConfig& config) {
  Eigen::Matrix<double, kRigErrors, 1> sigmas;
  sigmas << config.rig_sigma_length, Eigen::Vector3d::Constant(config.rig_sigma_axis_rad()),
      Eigen::Matrix<double, 6, 1>::Constant(config.rig_sigma_lens), 1;
  return sigmas;
}

PoseCovariance rig_covariance(const RigSensitivity& by_rig, const PoseConfig& config) {
  const RigSensitivity scaled = by_rig * rig_sigmas(config).asDiagonal();
  return scaled * scaled.transpose();
}

PoseCovariance whole_covariance(const UncertainPose& pose, const PoseConfig& config) {
  return pose.covariance + rig_covariance(pose.by_rig, config);
}

}  // namespace quadedge::pose
