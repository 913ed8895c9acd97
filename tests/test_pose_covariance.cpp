#include <catch2/catch.hpp>

#include "geometry/uncertain_pose.hpp"

using namespace quadedge;
using pose::RelativePose;
using pose::UncertainPose;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr double kSmall = 1e-6;

Eigen::Isometry3d some_transform(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

PoseCovariance some_covariance(double scale) {
  PoseCovariance covariance;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) covariance(i, j) = scale * (i == j ? 2.0 + i : 0.1 * (i + j));
  }
  return covariance;
}

Eigen::Matrix3d turn_by(const Eigen::Vector3d& rotation) {
  return rotation.norm() > 0 ? Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix()
                             : Eigen::Matrix3d::Identity();
}

/// The pose with an error as PoseCovariance defines it.
Eigen::Isometry3d erring(const Eigen::Isometry3d& pose, const Vector6& error) {
  Eigen::Isometry3d result = pose;
  result.translation() += error.head<3>();
  result.linear() = turn_by(error.tail<3>()) * pose.linear();
  return result;
}

Vector6 error_of(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& pose) {
  const Eigen::AngleAxisd turn(estimate.linear() * pose.linear().transpose());
  Vector6 error;
  error << estimate.translation() - pose.translation(), turn.angle() * turn.axis();
  return error;
}

}  // namespace

TEST_CASE("pose covariance: a motion's inverse propagates small errors of the motion", "[odometry]") {
  RelativePose motion;
  motion.transform = some_transform(0.8, {1, -2, 0.5}, {0.4, 2, -1});
  motion.covariance = some_covariance(1e-4);
  const UncertainPose pose = pose::pose_in_earlier(motion);
  CHECK(pose.fixed_from_camera.isApprox(motion.transform.inverse()));
  Eigen::Matrix<double, 6, 6> jacobian;
  for (int i = 0; i < 6; ++i) {
    const Vector6 change = kSmall * Vector6::Unit(i);  // left perturbation: rotation, translation
    Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
    step.linear() = turn_by(change.head<3>());
    step.translation() = change.tail<3>();
    jacobian.col(i) = error_of((step * motion.transform).inverse(), pose.fixed_from_camera) / kSmall;
  }
  const PoseCovariance expected = jacobian * motion.covariance * jacobian.transpose();
  CHECK((pose.covariance - expected).norm() < 1e-5 * expected.norm());
}

TEST_CASE("pose covariance: a chain propagates small errors of both links", "[odometry]") {
  const UncertainPose key{some_transform(0.4, {1, 2, 3}, {0.5, -1, 2}), some_covariance(1e-4)};
  const UncertainPose current{some_transform(-0.7, {2, -1, 1}, {1, 3, -0.4}), some_covariance(2e-4)};
  const UncertainPose chain = key * current;
  Eigen::Matrix<double, 6, 6> of_key, of_current;
  for (int i = 0; i < 6; ++i) {
    const Vector6 change = kSmall * Vector6::Unit(i);
    of_key.col(i) =
        error_of(erring(key.fixed_from_camera, change) * current.fixed_from_camera, chain.fixed_from_camera) / kSmall;
    of_current.col(i) =
        error_of(key.fixed_from_camera * erring(current.fixed_from_camera, change), chain.fixed_from_camera) / kSmall;
  }
  const PoseCovariance expected =
      of_key * key.covariance * of_key.transpose() + of_current * current.covariance * of_current.transpose();
  CHECK((chain.covariance - expected).norm() < 1e-5 * expected.norm());
}

TEST_CASE("pose covariance: a pose's inverse propagates its small errors", "[odometry]") {
  const UncertainPose there{some_transform(0.4, {1, 2, 3}, {0.5, -1, 2}), some_covariance(1e-4), {}};
  const UncertainPose back = inverse(there);
  Eigen::Matrix<double, 6, 6> jacobian;
  for (int i = 0; i < 6; ++i) {
    const Vector6 change = kSmall * Vector6::Unit(i);
    jacobian.col(i) = error_of(erring(there.fixed_from_camera, change).inverse(), back.fixed_from_camera) / kSmall;
  }
  const PoseCovariance expected = jacobian * there.covariance * jacobian.transpose();
  CHECK((back.covariance - expected).norm() < 1e-5 * expected.norm());
}
