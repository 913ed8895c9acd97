#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "pose/refinement.hpp"

using namespace quadedge::pose;

TEST_CASE("The analytic Jacobians are the residuals' derivatives", "[pose][residuals]") {
  generated::Random random(20);
  const NoiseModel noise{quadedge::PoseConfig{}};
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    generated::Problem problem;
    problem.rig = rig;
    problem.near = 2;
    problem.far = 20;
    problem.quads = 30;
    problem.motion = random.motion(0.1, 0.5);
    problem.noise = {0.3, 0.5, 0.05};
    const auto g = generated::generate(problem, 21);
    const Eigen::Isometry3d pose = random.motion(0.02, 0.1) * problem.motion;
    for (std::size_t i = 0; i < g.quads.size(); ++i) {
      const FitTerm term = make_term(g.quads, i, noise);
      Linearisation at, plus, minus;
      REQUIRE(linearise(term, rig.left, pose, 0.7, at));
      const double h = 1e-5;
      for (int k = 0; k < 6; ++k) {
        Vector6d step = Vector6d::Zero();
        step(k) = h;
        REQUIRE(linearise(term, rig.left, perturb(step, pose), 0.7, plus));
        REQUIRE(linearise(term, rig.left, perturb(-step, pose), 0.7, minus));
        const Eigen::Vector3d place = (plus.place - minus.place) / (2 * h);
        CHECK((place - at.place_by_pose.col(k)).norm() < 1e-5 * (1 + place.norm()));
        Eigen::Vector2d turned = Eigen::Vector2d::Zero();
        if (k < 3) turned = at.direction_by_rotation.col(k);
        CHECK(((plus.direction - minus.direction) / (2 * h) - turned).norm() < 1e-5 * (1 + turned.norm()));
      }
      REQUIRE(linearise(term, rig.left, pose, 0.7 + h, plus));
      REQUIRE(linearise(term, rig.left, pose, 0.7 - h, minus));
      CHECK(((plus.place - minus.place) / (2 * h) - at.place_by_depth).norm() < 1e-5 * (1 + at.place_by_depth.norm()));
      FitTerm nearer = term, farther = term;
      nearer.inverse_depth += h * term.inverse_depth_per_pixel;
      nearer.inverse_depth_bar += h * term.inverse_depth_bar_per_pixel;
      farther.inverse_depth -= h * term.inverse_depth_per_pixel;
      farther.inverse_depth_bar -= h * term.inverse_depth_bar_per_pixel;
      REQUIRE(linearise(nearer, rig.left, pose, 0.7, plus));
      REQUIRE(linearise(farther, rig.left, pose, 0.7, minus));
      CHECK(((plus.place - minus.place) / (2 * h) - at.place_by_offset).norm() <
            1e-5 * (1 + at.place_by_offset.norm()));
      FitTerm sloped = term;
      sloped.tangent += h * term.slope_sigma * term.ray;
      REQUIRE(linearise(sloped, rig.left, pose, 0.7, plus));
      CHECK(((plus.direction - at.direction) / h - at.direction_by_slope).norm() <
            1e-4 * (1 + at.direction_by_slope.norm()));
    }
  }
}

TEST_CASE("Residuals vanish at the true motion and count in standard deviations", "[pose][residuals]") {
  quadedge::PoseConfig config;
  const NoiseModel noise(config);
  CHECK(noise.on_epipolar_line(1.0) == Approx(config.sigma_across));
  CHECK(noise.on_epipolar_line(0.0) == Approx(config.sigma_along));

  generated::Problem problem;
  problem.rig = generated::crooked_rig();
  problem.near = 2;
  problem.far = 20;
  problem.motion.translation() << 0.1, 0.05, -0.3;
  const auto exact = generated::generate(problem, 22);
  Linearisation linear;
  for (std::size_t i = 0; i < exact.quads.size(); ++i) {
    const FitTerm term = make_term(exact.quads, i, noise);
    REQUIRE(linearise(term, problem.rig.left, problem.motion, 0.0, linear));
    CHECK(linear.place.norm() < 1e-6);
    CHECK(linear.direction.norm() < 1e-5);
  }

  // Without noise before, place residuals at the truth are standard normal.
  problem.quads = 4000;
  problem.noise = {config.sigma_across, config.sigma_along, 2.0 * 3.14159265358979323846 / 180};
  const auto noisy = generated::generate(problem, 23);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < noisy.quads.size(); ++i) {
    const FitTerm term = make_term(noisy.quads, i, noise);
    REQUIRE(linearise(term, problem.rig.left, problem.motion, 0.0, linear));
    const Eigen::Vector3d expected = Eigen::Vector3d::Ones() + linear.place_by_depth.cwiseAbs2();
    squares += linear.place.cwiseAbs2().cwiseQuotient(expected) / 4000.0;
  }
  for (int row = 0; row < 3; ++row) CHECK(squares(row) == Approx(1.0).margin(0.08));
}

TEST_CASE("A point behind the later camera has no residual", "[pose][residuals]") {
  generated::Problem problem;
  problem.quads = 1;
  const auto g = generated::generate(problem, 24);
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
  away.translation() << 0, 0, -1000;
  Linearisation linear;
  CHECK_FALSE(
      linearise(make_term(g.quads, 0, NoiseModel(quadedge::PoseConfig{})), problem.rig.left, away, 0.0, linear));
}
