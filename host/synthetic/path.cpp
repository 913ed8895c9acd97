#include "synthetic/path.hpp"

#include <cmath>

namespace quadedge::synthetic {
namespace {

/// An ellipse in the horizontal plane, run through in 114 frames while height and attitude sway in other rhythms.
Eigen::Isometry3d room_from_left(double phase) {
  const double p = 0.055 * phase;
  const double yaw = -0.14 * std::sin(p) + 0.03 * std::sin(1.7 * p + 1.0);  // towards the middle of the scene
  const double pitch = 0.035 * std::sin(1.3 * p + 0.4);
  const double roll = 0.05 * std::sin(1.1 * p + 2.0);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 0.50 * std::sin(p), 0.10 * std::sin(0.73 * p + 0.6),
      -0.24 * std::cos(p) + 0.02 * std::sin(2.1 * p);
  pose.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  return pose;
}

}  // namespace

Eigen::Isometry3d world_from_left(double phase) {
  if (phase == 0.0) return Eigen::Isometry3d::Identity();  // exactly
  return room_from_left(0.0).inverse() * room_from_left(phase);
}

}  // namespace quadedge::synthetic
