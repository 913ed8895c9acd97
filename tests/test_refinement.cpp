#include <catch2/catch.hpp>

#include "refinement_trials.hpp"

using namespace quadedge::pose;

TEST_CASE("Exact quads lead back to the exact motion from a start nearby", "[pose][refinement]") {
  generated::Problem problem = generated::drive();
  problem.noise = {};
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    problem.rig = rig;
    const auto g = generated::generate(problem, 30);
    generated::Random random(31);
    quadedge::PoseConfig config;
    const Refined refined = generated::refined_by(g.quads, rig, config, random.motion(3e-4, 0.005) * problem.motion);
    REQUIRE(refined.solved);
    CHECK(refined.inliers == static_cast<int>(g.quads.size()));
    CHECK((refined.current_from_previous.matrix() - problem.motion.matrix()).norm() < 1e-9);
  }
}

TEST_CASE("Noisy earlier depths leave no bias along the motion, and the covariance is consistent",
          "[long][pose][refinement]") {
  generated::Problem problem = generated::drive();
  const generated::Trials trials = generated::run_trials(problem, 150);
  for (int k = 0; k < 6; ++k) CHECK(std::abs(trials.mean(k)) < 3.5 * trials.standard_error(k));
  CHECK(std::abs(trials.mean(5)) < 2e-4);  // of 1.2 m
  CHECK(trials.nees > 0.7);
  CHECK(trials.nees < 1.5);
}

TEST_CASE("Far points with large disparity noise do not shorten the motion", "[long][pose][refinement]") {
  generated::Problem problem = generated::drive();
  problem.noise.across = 0.3;
  problem.near = 15;
  problem.far = 150;
  problem.quads = 1000;
  // With the earlier points taken as exact the mean is off by 0.7 mm, five standard errors.
  const generated::Trials trials = generated::run_trials(problem, 120);
  CHECK(trials.standard_error(5) < 1.6e-4);
  CHECK(std::abs(trials.mean(5)) < 3.5 * trials.standard_error(5));
}

TEST_CASE("Wrong quads that pass for inliers hardly move the pose", "[pose][refinement]") {
  generated::Problem problem = generated::drive();
  problem.quads = 1000;
  quadedge::PoseConfig robust, plain;
  plain.student_dof = 1e9;  // a normal distribution: plain least squares
  // 15 % of the quads one pixel off to one side: inside the 1.5 px of an inlier, seven standard deviations out.
  generated::Random random(33);
  QuadObservations quads;
  for (std::size_t i = 0; i < 1000; ++i) {
    const auto p = generated::random_point(problem.rig, problem.near, problem.far, random);
    const OrientedPoint q{problem.motion * p.point, problem.motion.linear() * p.tangent};
    const auto before = generated::disturb(problem.rig, p, problem.noise, true, random);
    auto after = generated::disturb(problem.rig, q, problem.noise, false, random);
    if (i % 7 == 0) after.left.x() += 1.0, after.right.x() += 1.0;
    quads.append(problem.rig, before, after, 1.0f, 0, static_cast<int>(i), generated::limits());
  }
  const auto error = [&](const quadedge::PoseConfig& config) {
    const Refined refined = generated::refined_by(quads, problem.rig, config, problem.motion);
    REQUIRE(refined.solved);
    return generated::error_of(refined.current_from_previous, problem.motion).head<3>().norm();
  };
  // A plain mean turns by about 0.14 px / 700 px = 2e-4 rad.
  CHECK(error(plain) > 1.5e-4);
  CHECK(error(robust) < 0.6 * error(plain));
}

TEST_CASE("Quads that cannot fix a motion are reported as unsolved", "[pose][refinement]") {
  generated::Problem problem = generated::drive();
  quadedge::PoseConfig config;
  problem.quads = 1;
  const auto one = generated::generate(problem, 34);
  CHECK_FALSE(generated::refined_by(one.quads, problem.rig, config, problem.motion).solved);
  const QuadObservations none;
  CHECK_FALSE(generated::refined_by(none, problem.rig, config, problem.motion).solved);
}
