#include "common/epipolar_rows.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace quadedge {
namespace {

/// Maximum ratio between the sines of the angles that matching edges form with their epipolar lines.
constexpr float kDirectionSlack = 1.2F;

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

SelectionArguments selection_arguments(const StereoRig& rig, Side side, const StereoConfig& config) {
  const PinholeCamera& camera = side == Side::left ? rig.left : rig.right;
  return {camera.width, camera.height, epipolar_rows(rig, side),
          static_cast<float>(std::sin(config.min_epipolar_angle_rad())), side == Side::left ? 1.0F : kDirectionSlack};
}

}  // namespace quadedge
