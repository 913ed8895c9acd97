#include "pose/two_quads.hpp"

#include <cmath>

namespace quadedge::pose {

namespace {

/// Computes the orthonormal frame [e1 e2 e3] of a pair; returns false if it is undefined.
bool build_frame(const OrientedPair& pair, double max_cosine, Eigen::Matrix3d& frame) {
  const Eigen::Vector3d d = pair.second.point - pair.first.point;
  const double length = d.norm();
  if (!(length > 0)) return false;
  const Eigen::Vector3d e1 = d / length;
  const double cosine = e1.dot(pair.first.tangent);
  if (!(std::abs(cosine) < max_cosine)) return false;
  const Eigen::Vector3d e2 = (pair.first.tangent - cosine * e1).normalized();
  frame << e1, e2, e1.cross(e2);
  return true;
}

}  // namespace

std::optional<Eigen::Isometry3d> solve_two_quads(const OrientedPair& previous, const OrientedPair& current,
                                                 double max_cosine) {
  Eigen::Matrix3d frame, frame_bar;
  if (!build_frame(previous, max_cosine, frame) || !build_frame(current, max_cosine, frame_bar)) return std::nullopt;
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  current_from_previous.linear() = frame_bar * frame.transpose();
  current_from_previous.translation() =
      0.5 * (current.first.point + current.second.point -
             current_from_previous.linear() * (previous.first.point + previous.second.point));
  return current_from_previous;
}

}  // namespace quadedge::pose
