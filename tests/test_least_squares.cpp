#include "generated_quads.hpp"
#include "motion/least_squares.hpp"

using namespace quadedge::pose;

TEST_CASE("A perturbation is a rotation followed by a translation", "[pose]") {
  generated::Random random(35);
  const Eigen::Isometry3d motion = random.motion(1.0, 2.0);
  Vector6d step;
  step << 0.1, -0.2, 0.3, 1, 2, 3;
  const Eigen::Isometry3d moved = perturb(step, motion);
  const Eigen::AngleAxisd turn(step.head<3>().norm(), step.head<3>().normalized());
  const Eigen::Vector3d p(1, -2, 4);
  CHECK((moved * p - (turn * (motion * p) + step.tail<3>())).norm() < 1e-12);
}

TEST_CASE("Normal equations that leave a direction undetermined have no solution", "[pose]") {
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

TEST_CASE("The scale of errors is their median over the expected one, never zero", "[pose]") {
  std::vector<double> values;
  CHECK(measured_scale({8, 2, 1e9, 4, 3}, 5, 2.0, values) == 2.0);
  CHECK(measured_scale({8, 2, 6, 4, 3}, 3, 2.0, values) == 3.0);  // only the first three
  CHECK(measured_scale({0, 0, 0}, 3, 2.0, values) == kSmallestScale);
}

TEST_CASE("The median of many errors is the middle one, also among equal ones", "[pose]") {
  generated::Random random(7);
  std::vector<double> values;
  for (const std::size_t count : {1, 2, 16, 17, 100, 1001, 9000}) {
    for (const int distinct : {1, 3, 1000000}) {
      std::vector<double> errors(count);
      for (double& error : errors) error = std::floor(distinct * random.uniform(0, 1)) + 1;
      const std::size_t every = std::max<std::size_t>(1, count / kScaleErrors);
      std::vector<double> used;
      for (std::size_t k = 0; k < count; k += every) used.push_back(errors[k]);
      std::sort(used.begin(), used.end());
      CHECK(measured_scale(errors, count, 1.0, values) == used[used.size() / 2]);
    }
  }
}
