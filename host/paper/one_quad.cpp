#include "paper/one_quad.hpp"

namespace quadedge::paper {

Eigen::Matrix3d align(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d v = from.cross(to);
  const double cosine = from.dot(to);
  if (cosine < 0) {
    // 1 / (1 + c) loses precision near a half turn. Prepending a half turn about the same axis leaves an angle below 90
    // degrees.
    const Eigen::Vector3d axis = v - v.dot(from) * from;
    const Eigen::Vector3d u =
        axis.norm() > 0 ? Eigen::Vector3d(axis.normalized()) : Eigen::Vector3d(from.unitOrthogonal());
    const Eigen::Matrix3d half_turn = 2.0 * u * u.transpose() - Eigen::Matrix3d::Identity();
    return align(-from, to) * half_turn;
  }
  Eigen::Matrix3d skew;
  skew << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return Eigen::Matrix3d::Identity() + skew + skew * skew / (1.0 + cosine);
}

Eigen::Isometry3d motion_of_one_quad(const pose::OrientedPoint& previous, const pose::OrientedPoint& current,
                                     double theta) {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  current_from_previous.linear() =
      Eigen::AngleAxisd(theta, current.tangent).toRotationMatrix() * align(previous.tangent, current.tangent);
  current_from_previous.translation() = current.point - current_from_previous.linear() * previous.point;
  return current_from_previous;
}

}  // namespace quadedge::paper
