#include "pose/least_squares.hpp"

namespace quadedge::pose {

Eigen::Isometry3d perturb(const Vector6d& step, const Eigen::Isometry3d& current_from_previous) {
  const Eigen::Vector3d w = step.head<3>();
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0) turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle));
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  // Renormalised as a unit quaternion, so that the rotation stays orthonormal after many steps.
  result.linear() = (turn * Eigen::Quaterniond(current_from_previous.linear())).normalized().toRotationMatrix();
  result.translation() = turn * current_from_previous.translation() + step.tail<3>();
  return result;
}

}  // namespace quadedge::pose
