#include <catch2/catch.hpp>

#include "odometry/constant_velocity.hpp"

using quadedge::odometry::ConstantVelocity;

TEST_CASE("constant velocity: a motion over several intervals is divided evenly and repeated", "[odometry]") {
  ConstantVelocity velocity;
  CHECK_FALSE(velocity.predict(1));
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  velocity.observe(turn, 3);
  CHECK(Eigen::AngleAxisd(velocity.predict(1)->linear()).angle() == Approx(0.1));
  CHECK(velocity.predict(3)->isApprox(turn, 1e-12));
  CHECK(velocity.predict(0)->matrix() == Eigen::Matrix4d::Identity());

  Eigen::Isometry3d shift = Eigen::Isometry3d::Identity();
  shift.translation() = Eigen::Vector3d(0, 0.4, -1);
  velocity.observe(shift, 2);
  CHECK(velocity.predict(1)->translation().isApprox(Eigen::Vector3d(0, 0.2, -0.5)));
  CHECK(velocity.predict(5)->translation().isApprox(Eigen::Vector3d(0, 1, -2.5)));

  velocity.forget();
  CHECK_FALSE(velocity.predict(1));
}

TEST_CASE("constant velocity: a turning camera continues along its curve", "[odometry]") {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(0.1, 0, 0.7);
  ConstantVelocity velocity;
  velocity.observe(motion, 1);
  CHECK(velocity.predict(2)->isApprox(motion * motion, 1e-12));
}
