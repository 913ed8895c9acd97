#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "pose/least_squares.hpp"

using namespace quadedge::pose;

TEST_CASE("A perturbation is a rotation followed by a translation", "[pose][least_squares]") {
  generated::Random random(35);
  const Eigen::Isometry3d motion = random.motion(1.0, 2.0);
  Vector6d step;
  step << 0.1, -0.2, 0.3, 1, 2, 3;
  const Eigen::Isometry3d moved = perturb(step, motion);
  const Eigen::AngleAxisd turn(step.head<3>().norm(), step.head<3>().normalized());
  const Eigen::Vector3d p(1, -2, 4);
  CHECK((moved * p - (turn * (motion * p) + step.tail<3>())).norm() < 1e-12);
}

TEST_CASE("Normal equations that leave a direction undetermined have no solution", "[pose][least_squares]") {
  Normal<6> normal;
  normal.matrix.diagonal() << 1, 2, 3, 1e6, 1e-6, 4;
  normal.gradient << 1, -2, 3, -1e6, 1e-6, 0;
  Vector6d step;
  REQUIRE(solve(normal, step));
  Vector6d expected;
  expected << -1, 1, -1, 1, -1, 0;
  CHECK((step - expected).norm() < 1e-12);
  normal.matrix(1, 0) = normal.matrix(0, 1) = std::sqrt(2.0);  // rows 0 and 1 are linearly dependent
  CHECK_FALSE(solve(normal, step));
  normal.matrix(1, 0) = normal.matrix(0, 1) = 0;
  normal.matrix(4, 4) = 0;
  CHECK_FALSE(solve(normal, step));
}

TEST_CASE("The scale of errors is their median over the expected one, never zero", "[pose][least_squares]") {
  std::vector<double> sorted;
  CHECK(measured_scale({8, 2, 1e9, 4, 3}, 5, 2.0, sorted) == 2.0);
  CHECK(measured_scale({8, 2, 6, 4, 3}, 3, 2.0, sorted) == 3.0);  // only the first three
  CHECK(measured_scale({0, 0, 0}, 3, 2.0, sorted) == kSmallestScale);
}
