#include "geometry/uncertain_pose.hpp"
#include "testing.hpp"

using namespace quadedge;
using pose::RelativePose;
using pose::UncertainPose;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Eigen::Isometry3d some_transform(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation) {
  return Eigen::Translation3d(translation) * Eigen::AngleAxisd(angle, axis.normalized());
}

Matrix6 some_covariance(double scale) {
  Matrix6 covariance;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) covariance(i, j) = scale * (i == j ? 2.0 + i : 0.1 * (i + j));
  return covariance;
}

Eigen::Quaterniond turn_by(const Eigen::Vector3d& rotation) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
}

Eigen::Vector3d turn_between(const Eigen::Isometry3d& to, const Eigen::Isometry3d& from) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  return turn.angle() * turn.axis();
}

/// A pose's error as PoseCovariance defines it: translation, then rotation.
Eigen::Isometry3d erring(const Eigen::Isometry3d& pose, const Vector6& error) {
  return Eigen::Translation3d(pose.translation() + error.head<3>()) *
         (turn_by(error.tail<3>()) * Eigen::Quaterniond(pose.linear()));
}
Vector6 error_of(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& pose) {
  Vector6 error;
  error << estimate.translation() - pose.translation(), turn_between(estimate, pose);
  return error;
}

/// The same of a motion, which is perturbed on the left: rotation, then translation.
Eigen::Isometry3d perturbed(const Eigen::Isometry3d& motion, const Vector6& change) {
  return Eigen::Translation3d(change.tail<3>()) * turn_by(change.head<3>()) * motion;
}
Vector6 change_of(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& motion) {
  Vector6 change;
  change << turn_between(estimate, motion), (estimate * motion.inverse()).translation();
  return change;
}

/// The covariance of a result by finite differences. \param error_after the result's error after a small one
template <class ErrorAfter>
Matrix6 propagated(const Matrix6& covariance, const ErrorAfter& error_after) {
  constexpr double kSmall = 1e-6;
  Matrix6 jacobian;
  for (int i = 0; i < 6; ++i) jacobian.col(i) = error_after(kSmall * Vector6::Unit(i)) / kSmall;
  return jacobian * covariance * jacobian.transpose();
}

void check_covariance(const Matrix6& found, const Matrix6& expected) {
  CHECK((found - expected).norm() < 1e-5 * expected.norm());
}

const Eigen::Isometry3d kFirst = some_transform(0.4, {1, 2, 3}, {0.5, -1, 2}),
                        kSecond = some_transform(-0.7, {2, -1, 1}, {1, 3, -0.4});

RelativePose relative(const Eigen::Isometry3d& transform, double scale) {
  RelativePose motion;
  motion.transform = transform;
  motion.covariance = some_covariance(scale);
  return motion;
}

}  // namespace

TEST_CASE("pose covariance: a motion's inverse propagates small errors of the motion") {
  const RelativePose motion = relative(some_transform(0.8, {1, -2, 0.5}, {0.4, 2, -1}), 1e-4);
  const UncertainPose pose = pose::pose_in_earlier(motion);
  CHECK(pose.fixed_from_camera.isApprox(motion.transform.inverse()));
  check_covariance(pose.covariance, propagated(motion.covariance, [&](const Vector6& change) {
                     return error_of(perturbed(motion.transform, change).inverse(), pose.fixed_from_camera);
                   }));
}

TEST_CASE("pose covariance: a chain propagates small errors of both links, an inverse those of its pose") {
  const UncertainPose key{kFirst, some_covariance(1e-4)}, current{kSecond, some_covariance(2e-4)},
      chain = key * current, back = inverse(key);
  check_covariance(chain.covariance, propagated(key.covariance, [&](const Vector6& error) {
                                       return error_of(erring(kFirst, error) * kSecond, chain.fixed_from_camera);
                                     }) + propagated(current.covariance, [&](const Vector6& error) {
                                       return error_of(kFirst * erring(kSecond, error), chain.fixed_from_camera);
                                     }));
  check_covariance(back.covariance, propagated(key.covariance, [&](const Vector6& error) {
                     return error_of(erring(kFirst, error).inverse(), back.fixed_from_camera);
                   }));
}

TEST_CASE("relative pose: a product propagates small errors of both factors, and the identity changes nothing") {
  const RelativePose first = relative(kFirst, 1e-4), second = relative(kSecond, 2e-4), both = first * second,
                     same = first * RelativePose();
  CHECK(both.transform.isApprox(kFirst * kSecond));
  check_covariance(both.covariance, propagated(first.covariance, [&](const Vector6& change) {
                                      return change_of(perturbed(kFirst, change) * kSecond, both.transform);
                                    }) + propagated(second.covariance, [&](const Vector6& change) {
                                      return change_of(kFirst * perturbed(kSecond, change), both.transform);
                                    }));
  CHECK(same.transform.matrix() == kFirst.matrix());
  CHECK(same.covariance == first.covariance);
}
