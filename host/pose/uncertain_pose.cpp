#include "pose/uncertain_pose.hpp"

namespace quadedge::pose {

namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace

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
  // A rotation error of the key rig also displaces the current camera, by its distance from the key rig.
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

}  // namespace quadedge::pose
