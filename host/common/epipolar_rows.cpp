#include "common/epipolar_rows.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace quadedge {
namespace {

/// Maximum ratio between the sines of the angles that matching edges form with their epipolar lines.
constexpr float kDirectionSlack = 1.2F;

/// The numbering of the pixel at which a right point would lie without `error`.
EpipolarRows corrected(EpipolarRows rows, const StereoRig& rig, const RectificationError& error) {
  const Eigen::Vector3d t = rig.right.matrix() * rig.right_from_left.translation();
  const Eigen::Vector2d along = (t.head<2>() - t.z() * Eigen::Vector2d(rig.right.cx, rig.right.cy)).normalized();
  const RectificationError::Plane plane = error.plane(rig.right.width, rig.right.height);
  const auto move = [&](float& x, float& y, float& one) {
    const double by = static_cast<double>(x) * along.y() - static_cast<double>(y) * along.x();
    x -= static_cast<float>(by * plane.x);
    y -= static_cast<float>(by * plane.y);
    one -= static_cast<float>(by * plane.one);
  };
  move(rows.across_x, rows.across_y, rows.across_1);
  move(rows.forward_x, rows.forward_y, rows.forward_1);
  return rows;
}

}  // namespace

EpipolarRows epipolar_rows(const StereoRig& rig, Side side) {
  const Eigen::Matrix3d rotation = rig.right_from_left.linear();
  const Eigen::Vector3d baseline = -(rotation.transpose() * rig.right_from_left.translation());
  const Eigen::Vector3d along = baseline.normalized();
  const Eigen::Vector3d axes = Eigen::Vector3d::UnitZ() + rotation.transpose() * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d forward = axes - axes.dot(along) * along;
  // Without such a plane (one camera behind the other), any plane serves.
  forward = forward.norm() > 1e-6 * axes.norm() ? Eigen::Vector3d(forward.normalized()) : along.unitOrthogonal();
  const Eigen::Vector3d across = forward.cross(along);
  const Eigen::Matrix3d rays = side == Side::left
                                   ? Eigen::Matrix3d(rig.left.matrix().inverse())
                                   : Eigen::Matrix3d(rotation.transpose() * rig.right.matrix().inverse());
  const Eigen::RowVector3d numerator = rig.left.fy * across.transpose() * rays;
  const Eigen::RowVector3d denominator = forward.transpose() * rays;
  const auto value = [](double number) { return static_cast<float>(number); };
  return {value(numerator.x()),   value(numerator.y()),   value(numerator.z()),
          value(denominator.x()), value(denominator.y()), value(denominator.z())};
}

SelectionArguments selection_arguments(const StereoRig& rig, Side side, const StereoConfig& config,
                                       const RectificationError& error) {
  const PinholeCamera& camera = side == Side::left ? rig.left : rig.right;
  const EpipolarRows rows = epipolar_rows(rig, side);
  return {camera.width, camera.height, side == Side::left ? rows : corrected(rows, rig, error),
          static_cast<float>(std::sin(config.min_epipolar_angle_rad())), side == Side::left ? 1.0F : kDirectionSlack};
}

}  // namespace quadedge
