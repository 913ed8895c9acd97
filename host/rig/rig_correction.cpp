/// \file rig_correction.cpp  Solves for pitch, roll and focal length by numeric derivatives of the rows' shape.
#include "rig/rig_correction.hpp"

#include <Eigen/LU>
#include <cmath>

#include "common/printed.hpp"
#include "geometry/calibration.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Applies the parts to a camera and its pose.
void apply(const Eigen::Vector3d& parts, PinholeCamera& right, Eigen::Isometry3d& right_from_left) {
  const Eigen::Vector3d to_left(-right_from_left.translation().x(), -right_from_left.translation().y(), 0);
  const Eigen::Vector3d turn =
      parts[RigCorrection::pitch] * to_left.normalized() + parts[RigCorrection::roll] * Eigen::Vector3d::UnitZ();
  (std::abs(to_left.x()) > std::abs(to_left.y()) ? right.fy : right.fx) *= 1 + parts[RigCorrection::focal];
  right_from_left = rotation_by(-turn) * right_from_left;
}

/// Of distances across the lines: that at the principal point, and their change over half the width and the height.
template <class Distance>
Eigen::Vector3d shape_of(const PinholeCamera& right, const Distance& distance) {
  const Eigen::Vector2d middle(right.cx, right.cy), x(0.25 * right.width, 0), y(0, 0.25 * right.height);
  return {distance(middle), distance(middle + x) - distance(middle - x), distance(middle + y) - distance(middle - y)};
}

}  // namespace

bool RigCorrection::is_certain(int part) const { return std::abs(parts[part]) > kTermSigmas * sigmas[part]; }

StereoCalibration RigCorrection::applied(StereoCalibration calibration) const {
  Eigen::Vector3d certain = Eigen::Vector3d::Zero();
  for (int part = 0; part < kParts; ++part)
    if (is_certain(part)) certain[part] = parts[part];
  apply(certain, calibration.right.camera, calibration.right_from_left);
  calibration.right_from_left = rounded_transform(calibration.right_from_left);
  return calibration;
}

std::string RigCorrection::text() const {
  const auto mark = [&](int part) { return is_certain(part) ? "" : " (not certain)"; };
  return printed(
      "according to the vertical residuals, the right camera is pitched by %+.3f +- %.3f degrees%s and rolled by %+.3f "
      "+- %.3f degrees%s against the calibration, and its focal length across the lines is off by %+.3f +- %.3f %%%s; "
      "yaw and other errors along the epipolar lines cannot be determined from them",
      parts[pitch] / kDegree, sigmas[pitch] / kDegree, mark(pitch), parts[roll] / kDegree, sigmas[roll] / kDegree,
      mark(roll), 100 * parts[focal], 100 * sigmas[focal], mark(focal));
}

RigCorrection correction_of(const StereoRig& rig, const RowModel& rows) {
  const Eigen::Vector3d t = rig.right.matrix() * rig.right_from_left.translation();
  const auto at_infinity = [](const PinholeCamera& left, const PinholeCamera& right, const Eigen::Matrix3d& rotation) {
    return Eigen::Matrix3d(right.matrix() * rotation * left.matrix().inverse());
  };
  const Eigen::Matrix3d calibrated = at_infinity(rig.left, rig.right, rig.right_from_left.linear());
  Eigen::Matrix3d by_parts;
  for (int part = 0; part < RigCorrection::kParts; ++part) {
    constexpr double kStep = 1e-4;
    PinholeCamera right = rig.right;
    Eigen::Isometry3d pose = rig.right_from_left;
    apply(kStep * Eigen::Vector3d::Unit(part), right, pose);
    const Eigen::Matrix3d moved = at_infinity(rig.left, right, pose.linear()) * calibrated.inverse();
    by_parts.col(part) = shape_of(rig.right, [&](const Eigen::Vector2d& at) {
      const Eigen::Vector2d along = (t.head<2>() - at * t.z()).normalized(),
                            move = (moved * at.homogeneous()).hnormalized() - at;
      return Eigen::Vector2d(along.y(), -along.x()).dot(move) / kStep;
    });
  }
  Eigen::Matrix<double, 3, RowModel::kTerms> by_terms;
  for (int term = 0; term < RowModel::kTerms; ++term) {
    const auto one = [&](int of) { return of == term ? 1.0 : 0.0; };
    const RectificationError error{one(0), one(1), one(2), one(3), one(4), one(5)};
    by_terms.col(term) = shape_of(rig.right, [&](const Eigen::Vector2d& at) {
      return error.at(at.x() / rig.right.width - 0.5, at.y() / rig.right.height - 0.5);
    });
  }
  const RowModel::Estimate found = rows.estimate();
  const Eigen::Matrix3d of_shape = by_parts.inverse();
  const Eigen::Matrix<double, 3, RowModel::kTerms> solution = of_shape * by_terms;
  const Eigen::Matrix3d covariance =
      solution * found.covariance * solution.transpose() + kRowFloor * kRowFloor * of_shape * of_shape.transpose();
  return {solution * found.terms, covariance.diagonal().cwiseSqrt()};
}

}  // namespace quadedge::rig
