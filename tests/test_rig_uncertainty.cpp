#include <catch2/catch.hpp>

#include "geometry/uncertain_pose.hpp"

using namespace quadedge;

namespace {

constexpr double kTiny = 1e-6;

Eigen::Isometry3d motion_of(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& way) {
  return Eigen::Translation3d(way) * Eigen::AngleAxisd(angle, axis.normalized());
}

pose::UncertainPose exact(const Eigen::Isometry3d& fixed_from_camera, double inverse_depth) {
  return {fixed_from_camera, PoseCovariance::Zero(), pose::rig_sensitivity(fixed_from_camera, inverse_depth)};
}

Eigen::Matrix<double, 6, 1> relative_error(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(estimate.linear() * truth.linear().transpose());
  Eigen::Matrix<double, 6, 1> error;
  error << estimate.translation() - truth.translation(), turn.angle() * turn.axis();
  return error;
}

const Eigen::Isometry3d kFirst = motion_of(0.3, {1, 2, -1}, {0.4, -0.2, 1}),
                        kSecond = motion_of(-0.5, {2, 0, 1}, {1, 0.1, 0.5});

}  // namespace

TEST_CASE("rig uncertainty: a rotated optical frame and a longer baseline change a motion as predicted", "[pose]") {
  const RigSensitivity by_rig = pose::rig_sensitivity(kFirst, 0.2);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Isometry3d turn = motion_of(kTiny, Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero());
    const auto error = relative_error(turn * kFirst * turn.inverse(), kFirst);
    CHECK((error / kTiny - by_rig.col(1 + axis)).norm() < 1e-4);
  }
  Eigen::Isometry3d longer = kFirst;
  longer.translation() *= 1 + kTiny;
  CHECK((relative_error(longer, kFirst) / kTiny - by_rig.col(0)).norm() < 1e-4);
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
  const auto step = exact(motion_of(0, {0, 0, 1}, {0, 0, 1}), 0.1);
  pose::UncertainPose far = step;
  for (int k = 1; k < 100; ++k) far = far * step;
  const double sigma = std::sqrt(pose::whole_covariance(far, config)(2, 2));
  CHECK(sigma == Approx(100 * config.rig_sigma_length));
  config.rig_sigma_length = config.rig_sigma_axis = config.rig_sigma_lens = 0;
  CHECK(pose::whole_covariance(far, config).norm() == 0);
}

TEST_CASE("rig uncertainty: residual distortion errs in proportion to the motion of the image", "[pose]") {
  PoseConfig config;
  config.rig_sigma_length = config.rig_sigma_axis = 0;
  const auto along = pose::whole_covariance(exact(motion_of(0, {0, 0, 1}, {0, 0, 1}), 0.2), config);
  const auto about = pose::whole_covariance(exact(motion_of(0.1, {0, 1, 0}, {0, 0, 0}), 0.2), config);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(std::sqrt(along(3 + axis, 3 + axis)) == Approx(0.2 * config.rig_sigma_lens));
    CHECK(along(axis, axis) == 0);
    CHECK(std::sqrt(about(3 + axis, 3 + axis)) == Approx(0.1 * config.rig_sigma_lens));
    CHECK(std::sqrt(about(axis, axis)) == Approx(0.1 / 0.2 * config.rig_sigma_lens));
  }
}
