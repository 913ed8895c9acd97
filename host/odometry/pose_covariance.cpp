#include "odometry/pose_covariance.hpp"

namespace quadedge::odometry {

UncertainPose pose_in_earlier(const RelativePose& current_from_earlier) {
  const Eigen::Isometry3d pose = current_from_earlier.transform.inverse();
  // With current_from_earlier perturbed by (w, v) the position errs by -R v and the rotation by -R w, R that of `pose`.
  PoseCovariance turned = PoseCovariance::Zero();  // from (rotation, translation) to (translation, rotation)
  turned.topRightCorner<3, 3>() = pose.linear();
  turned.bottomLeftCorner<3, 3>() = pose.linear();
  return {pose, turned * current_from_earlier.covariance * turned.transpose()};
}

UncertainPose operator*(const UncertainPose& world_from_key, const UncertainPose& key_from_current) {
  UncertainPose result{world_from_key.fixed_from_camera * key_from_current.fixed_from_camera, std::nullopt};
  if (!world_from_key.covariance || !key_from_current.covariance) return result;
  // The key's rotation errs about its own place, and carries the way from there to the current camera along.
  const Eigen::Matrix3d turn = world_from_key.fixed_from_camera.linear();
  const Eigen::Vector3d way = turn * key_from_current.fixed_from_camera.translation();
  PoseCovariance carried = PoseCovariance::Identity(), turned = PoseCovariance::Zero();
  carried.topRightCorner<3, 3>() << 0, way.z(), -way.y(), -way.z(), 0, way.x(), way.y(), -way.x(), 0;
  turned.topLeftCorner<3, 3>() = turn;
  turned.bottomRightCorner<3, 3>() = turn;
  result.covariance = carried * *world_from_key.covariance * carried.transpose() +
                      turned * *key_from_current.covariance * turned.transpose();
  return result;
}

}  // namespace quadedge::odometry
