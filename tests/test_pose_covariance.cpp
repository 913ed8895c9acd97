#include "geometry/uncertain_pose.hpp"
#include "testing.hpp"

using namespace quadedge;
using pose::RelativePose;
using pose::UncertainPose;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kSmall = 1e-6;

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
  Matrix6 jacobian;
  for (int i = 0; i < 6; ++i) jacobian.col(i) = error_after(kSmall * Vector6::Unit(i)) / kSmall;
  return jacobian * covariance * jacobian.transpose();
}

void check_covariance(const Matrix6& found, const Matrix6& expected) {
  CHECK((found - expected).norm() < 1e-5 * expected.norm());
}

const Eigen::Isometry3d kFirst = some_transform(0.4, {1, 2, 3}, {0.5, -1, 2}),
                        kSecond = some_transform(-0.7, {2, -1, 1}, {1, 3, -0.4});

UncertainPose exact(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth) {
  return {fixed_from_camera, PoseCovariance::Zero(), pose::rig_sensitivity(fixed_from_camera, inverse_depth)};
}

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

TEST_CASE("rig uncertainty: a rotated optical frame and a longer baseline change a motion as predicted", "[pose]") {
  const RigSensitivity by_rig = pose::rig_sensitivity(kFirst, 0.2);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Isometry3d turn = some_transform(kSmall, Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero());
    const auto error = error_of(turn * kFirst * turn.inverse(), kFirst);
    CHECK((error / kSmall - by_rig.col(1 + axis)).norm() < 1e-4);
  }
  Eigen::Isometry3d longer = kFirst;
  longer.translation() *= 1 + kSmall;
  CHECK((error_of(longer, kFirst) / kSmall - by_rig.col(0)).norm() < 1e-4);
}

TEST_CASE("rig uncertainty: the rig's errors along a chain add up to those of the whole motion", "[pose]") {
  const auto chain = exact(kFirst, 0.2) * exact(kSecond, 0.2);
  const RigSensitivity whole = pose::rig_sensitivity(kFirst * kSecond, 0.2);
  CHECK((chain.by_rig.leftCols<4>() - whole.leftCols<4>()).norm() < 1e-9);
  CHECK((inverse(chain).by_rig.leftCols<4>() - pose::rig_sensitivity((kFirst * kSecond).inverse(), 0.2).leftCols<4>())
            .norm() < 1e-9);
}

TEST_CASE("rig uncertainty: it grows linearly with the path length and is zero for an exact rig", "[pose]") {
  PoseConfig config;
  const auto step = exact(some_transform(0, {0, 0, 1}, {0, 0, 1}), 0.1);
  UncertainPose far = step;
  for (int k = 1; k < 100; ++k) far = far * step;
  const double sigma = std::sqrt(pose::whole_covariance(far, config)(2, 2));
  CHECK(sigma == Approx(100 * config.rig_sigma_length));
  config.rig_sigma_length = config.rig_sigma_axis = config.rig_sigma_lens = 0;
  CHECK(pose::whole_covariance(far, config).norm() == 0);
}

TEST_CASE("rig uncertainty: residual distortion errs in proportion to the motion of the image", "[pose]") {
  PoseConfig config;
  config.rig_sigma_length = config.rig_sigma_axis = 0;
  const auto along = pose::whole_covariance(exact(some_transform(0, {0, 0, 1}, {0, 0, 1}), 0.2), config);
  const auto about = pose::whole_covariance(exact(some_transform(0.1, {0, 1, 0}, {0, 0, 0}), 0.2), config);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(std::sqrt(along(3 + axis, 3 + axis)) == Approx(0.2 * config.rig_sigma_lens));
    CHECK(along(axis, axis) == 0);
    CHECK(std::sqrt(about(3 + axis, 3 + axis)) == Approx(0.1 * config.rig_sigma_lens));
    CHECK(std::sqrt(about(axis, axis)) == Approx(0.1 / 0.2 * config.rig_sigma_lens));
  }
}
