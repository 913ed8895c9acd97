#include "pose/relative_pose.hpp"

namespace quadedge::pose {

Eigen::Matrix<double, 6, 6> adjoint(const Eigen::Isometry3d& transform) {
  Eigen::Matrix3d cross;
  const Eigen::Vector3d t = transform.translation();
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Eigen::Matrix<double, 6, 6> result = Eigen::Matrix<double, 6, 6>::Zero();
  result.topLeftCorner<3, 3>() = transform.linear();
  result.bottomRightCorner<3, 3>() = transform.linear();
  result.bottomLeftCorner<3, 3>() = cross * transform.linear();
  return result;
}

RelativePose operator*(const RelativePose& c_from_b, const RelativePose& b_from_a) {
  const Eigen::Matrix<double, 6, 6> carried = adjoint(c_from_b.transform);
  return {c_from_b.transform * b_from_a.transform,
          c_from_b.covariance + carried * b_from_a.covariance * carried.transpose()};
}

}  // namespace quadedge::pose
