#include <catch2/catch.hpp>

#include "geometry/uncertain_pose.hpp"

using quadedge::pose::RelativePose;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

namespace {

/// The pose with a small left perturbation: rotation [rad], then translation [m].
Eigen::Isometry3d perturbed(const Eigen::Isometry3d& pose, const Vector6& change) {
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d turn = change.head<3>();
  if (turn.norm() > 0) step.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  step.translation() = change.tail<3>();
  return step * pose;
}

/// The left perturbation from `from` to `to`, which are close to each other.
Vector6 change_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::Isometry3d step = to * from.inverse();
  const Eigen::AngleAxisd turn(step.linear());
  Vector6 change;
  change << turn.angle() * turn.axis(), step.translation();
  return change;
}

RelativePose some_pose(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation, double scale) {
  RelativePose pose;
  pose.transform.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.transform.translation() = translation;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) pose.covariance(i, j) = scale * (i == j ? 2.0 + i : 0.1 * (i + j));
  }
  return pose;
}

}  // namespace

TEST_CASE("relative pose: the covariance of a product propagates small errors of both factors", "[odometry]") {
  const RelativePose c_from_b = some_pose(0.4, {1, 2, 3}, {0.5, -1, 2}, 1e-4),
                     b_from_a = some_pose(-0.7, {2, -1, 1}, {1, 3, -0.4}, 2e-4);
  const RelativePose c_from_a = c_from_b * b_from_a;
  CHECK(c_from_a.transform.isApprox(c_from_b.transform * b_from_a.transform));
  // Columns of both Jacobians by finite differences.
  Matrix6 of_first, of_second;
  const double h = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6 change = h * Vector6::Unit(i);
    of_first.col(i) =
        change_between(c_from_a.transform, perturbed(c_from_b.transform, change) * b_from_a.transform) / h;
    of_second.col(i) =
        change_between(c_from_a.transform, c_from_b.transform * perturbed(b_from_a.transform, change)) / h;
  }
  const Matrix6 expected =
      of_first * c_from_b.covariance * of_first.transpose() + of_second * b_from_a.covariance * of_second.transpose();
  CHECK((c_from_a.covariance - expected).norm() < 1e-5 * expected.norm());
}

TEST_CASE("relative pose: the identity changes nothing", "[odometry]") {
  const RelativePose pose = some_pose(0.4, {1, 2, 3}, {0.5, -1, 2}, 1e-4), same = pose * RelativePose();
  CHECK(same.transform.matrix() == pose.transform.matrix());
  CHECK(same.covariance == pose.covariance);
}
