#pragma once
/// \file calibration.hpp  Numbers of calibrations and poses: bounds of those that a camera can have, whoever states
/// them, and rigid transforms rounded to 1e-9 m and 1e-9 rad, as stored in StereoCalibration.

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "quadedge/camera.hpp"

namespace quadedge {

/// A number out of bounds.
struct CameraComplaint {
  std::string found, expected;
};

/// The first number of the camera that no camera has: focal lengths outside 0.01 to 100 image sizes (180 to 0.6
/// degrees), one ten times the other, a principal point ten image sizes away. A width or height of 0 is unknown; the
/// largest possible image then stands for its size.
std::optional<CameraComplaint> complaint_about(const PinholeCamera& camera);

/// Largest absolute value of a distortion coefficient; rational models reach some hundreds.
constexpr double kLargestCoefficient = 1e5;

/// How far a matrix is from a rotation: the largest absolute entry of R^T R - I, or infinity if the matrix mirrors or
/// if one of its numbers is not finite. Readers project what they accept onto the rotations, so that only rounding
/// remains.
double rotation_error(const Eigen::Matrix3d& matrix);
/// Whether the last row is (0, 0, 0, 1).
bool is_affine(const Eigen::Isometry3d& transform);
/// Largest rotation_error() of what readers and programs hand on.
constexpr double kRotationTolerance = 1e-6;

/// Rounds to 1e-9 without negative zeros.
inline Eigen::Vector3d rounded(const Eigen::Vector3d& values) {
  constexpr double kPerUnit = 1e9;
  return (values * kPerUnit).array().round().matrix() / kPerUnit + Eigen::Vector3d::Zero();
}

/// Rotation vector [rad], rounded.
inline Eigen::Vector3d rounded_rotation(const Eigen::Isometry3d& transform) {
  const Eigen::AngleAxisd turn(transform.linear());
  return rounded(turn.angle() * turn.axis());
}

inline Eigen::Matrix3d rotation_by(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

inline Eigen::Isometry3d rounded_transform(const Eigen::Isometry3d& transform) {
  Eigen::Isometry3d result(rotation_by(rounded_rotation(transform)));
  result.translation() = rounded(transform.translation());
  return result;
}

}  // namespace quadedge
