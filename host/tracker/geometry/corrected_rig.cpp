/// \file corrected_rig.cpp  Moves the right principal point along the direction in which disparities grow.
#include "geometry/corrected_rig.hpp"

namespace quadedge {

Eigen::Vector2d direction_of_nearer(const StereoRig& rig) {
  // For the middle of the image, between depths of 100 and 50 baselines.
  const Eigen::Vector3d ray = rig.left.ray({0.5 * (rig.left.width - 1), 0.5 * (rig.left.height - 1)});
  const Eigen::Vector2d far = rig.right.project(rig.right_from_left * Eigen::Vector3d(100 * rig.baseline() * ray));
  return (rig.right.project(rig.right_from_left * Eigen::Vector3d(50 * rig.baseline() * ray)) - far).normalized();
}

StereoRig corrected_rig(const StereoRig& rig, const RigEstimate& estimate) {
  const Eigen::Vector2d moved_by = -estimate.added_disparity() * direction_of_nearer(rig);
  StereoRig moved;
  moved.left = rig.left;
  moved.right = rig.right;
  moved.right_from_left = rig.right_from_left;
  moved.max_value = rig.max_value;
  moved.right.cx += moved_by.x();
  moved.right.cy += moved_by.y();
  return moved;
}

}  // namespace quadedge
