#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "pose/refinement.hpp"

using namespace quadedge::pose;

namespace {

Refined refined_by(const QuadObservations& quads, const quadedge::StereoRig& rig, const quadedge::PoseConfig& config,
                   const Eigen::Isometry3d& initial, double offset_variance = 0) {
  RefinementWorkspace workspace;
  std::vector<std::uint8_t> inlier;
  return refine(quads, rig, config, initial, offset_variance, workspace, inlier);
}

generated::Problem drive() {
  generated::Problem problem;
  problem.motion.linear() = Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.1, 1, 0.1).normalized()).toRotationMatrix();
  problem.motion.translation() << 0.05, 0.02, -1.2;
  problem.noise = {0.15, 0.5, 0.035};
  return problem;
}

/// Left perturbation that takes the truth to the estimate.
Vector6d error_of(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(estimate.linear() * truth.linear().transpose());
  Vector6d error;
  error << turn.angle() * turn.axis(), estimate.translation() - turn * truth.translation();
  return error;
}

struct Trials {
  Vector6d mean = Vector6d::Zero(), standard_error = Vector6d::Zero();
  double nees = 0;  ///< mean per degree of freedom
};

Trials run_trials(const generated::Problem& problem, int trials) {
  quadedge::PoseConfig config;
  Trials result;
  Vector6d squares = Vector6d::Zero();
  for (int trial = 0; trial < trials; ++trial) {
    const auto g = generated::generate(problem, 1000 + static_cast<std::uint64_t>(trial));
    const Refined refined = refined_by(g.quads, problem.rig, config, problem.motion);
    REQUIRE(refined.solved);
    const Vector6d error = error_of(refined.current_from_previous, problem.motion);
    result.mean += error / trials;
    squares += error.cwiseAbs2() / trials;
    result.nees += error.dot(refined.covariance.ldlt().solve(error)) / (6.0 * trials);
  }
  result.standard_error = ((squares - result.mean.cwiseAbs2()) / trials).cwiseSqrt();
  return result;
}

}  // namespace

TEST_CASE("Exact quads lead back to the exact motion from a start nearby", "[pose][refinement]") {
  generated::Problem problem = drive();
  problem.noise = {};
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    problem.rig = rig;
    const auto g = generated::generate(problem, 30);
    generated::Random random(31);
    quadedge::PoseConfig config;
    const Refined refined = refined_by(g.quads, rig, config, random.motion(3e-4, 0.005) * problem.motion);
    REQUIRE(refined.solved);
    CHECK(refined.inliers == static_cast<int>(g.quads.size()));
    CHECK((refined.current_from_previous.matrix() - problem.motion.matrix()).norm() < 1e-9);
  }
}

TEST_CASE("Noisy earlier depths leave no bias along the motion, and the covariance is honest",
          "[long][pose][refinement]") {
  generated::Problem problem = drive();
  const Trials trials = run_trials(problem, 150);
  for (int k = 0; k < 6; ++k) CHECK(std::abs(trials.mean(k)) < 3.5 * trials.standard_error(k));
  CHECK(std::abs(trials.mean(5)) < 2e-4);  // of 1.2 m
  CHECK(trials.nees > 0.7);
  CHECK(trials.nees < 1.5);
}

TEST_CASE("Far points with large disparity noise do not shorten the motion", "[long][pose][refinement]") {
  generated::Problem problem = drive();
  problem.noise.across = 0.3;
  problem.near = 15;
  problem.far = 150;
  problem.quads = 1000;
  // With the earlier points taken as exact the mean is off by 0.7 mm, five standard errors.
  const Trials trials = run_trials(problem, 120);
  CHECK(trials.standard_error(5) < 1.6e-4);
  CHECK(std::abs(trials.mean(5)) < 3.5 * trials.standard_error(5));
}

TEST_CASE("The covariance stays honest with few quads and with rows of edges that share their errors",
          "[long][pose][refinement]") {
  generated::Problem problem = drive();
  problem.quads = 60;
  const Trials few = run_trials(problem, 200);
  CHECK(few.nees > 0.7);
  CHECK(few.nees < 1.5);
  problem.quads = 1600;
  problem.copies = 8;
  const Trials rows = run_trials(problem, 100);
  CHECK(rows.nees > 0.7);
  CHECK(rows.nees < 1.5);
}

namespace {

/// Moves the later edges of each square region of the image by an error of the region's own, `sigma` px in both
/// directions.
QuadObservations with_region_errors(const generated::Problem& problem, double side, double sigma, std::uint64_t seed) {
  generated::Random random(seed);
  std::vector<Eigen::Vector2d> errors(400);
  for (auto& error : errors) error = sigma * Eigen::Vector2d(random.normal(), random.normal());
  QuadObservations quads;
  while (static_cast<int>(quads.size()) < problem.quads) {
    const auto p = generated::random_point(problem.rig, problem.near, problem.far, random);
    const OrientedPoint moved{problem.motion * p.point, problem.motion.linear() * p.tangent};
    if (moved.point.z() < 0.5 * problem.near) continue;
    const auto before = generated::disturb(problem.rig, p, problem.noise, true, random);
    auto after = generated::disturb(problem.rig, moved, problem.noise, false, random);
    const Eigen::Vector2d region = (after.left / side).array().floor();
    if (region.minCoeff() < 0 || region.maxCoeff() >= 20) continue;
    const auto& error = errors[static_cast<std::size_t>(20 * region.y() + region.x())];
    after.left += error;
    after.right += error;
    quads.append(problem.rig, before, after, 1.0f, 0, static_cast<int>(quads.size()), generated::limits());
  }
  return quads;
}

}  // namespace

TEST_CASE("The covariance grows with errors that are alike over large regions, and only with them",
          "[long][pose][refinement]") {
  generated::Problem problem = drive();
  problem.quads = 3000;
  quadedge::PoseConfig config;
  constexpr int kTrials = 60;
  for (const double sigma : {0.0, 0.1}) {
    double nees = 0, growth = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto quads = with_region_errors(problem, 90, sigma, 2000 + static_cast<std::uint64_t>(trial));
      const Refined refined = refined_by(quads, problem.rig, config, problem.motion);
      REQUIRE(refined.solved);
      const Vector6d error = error_of(refined.current_from_previous, problem.motion);
      nees += error.dot(refined.covariance.ldlt().solve(error)) / (6.0 * kTrials);
      const auto alone = with_region_errors(problem, 90, 0, 2000 + static_cast<std::uint64_t>(trial));
      const Refined without = refined_by(alone, problem.rig, config, problem.motion);
      growth += (refined.covariance * without.covariance.inverse()).trace() / (6.0 * kTrials);
    }
    INFO("regions' errors of " << sigma << " px: normalised error " << nees << ", covariance times " << growth);
    CHECK(nees > 0.7);
    CHECK(nees < 1.5);
    if (sigma > 0) CHECK(growth > 3);
  }
}

TEST_CASE("Wrong quads that pass for inliers hardly move the pose", "[pose][refinement]") {
  generated::Problem problem = drive();
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
    const Refined refined = refined_by(quads, problem.rig, config, problem.motion);
    REQUIRE(refined.solved);
    return error_of(refined.current_from_previous, problem.motion).head<3>().norm();
  };
  // A plain mean turns by about 0.14 px / 700 px = 2e-4 rad.
  CHECK(error(plain) > 1.5e-4);
  CHECK(error(robust) < 0.6 * error(plain));
}

TEST_CASE("Quads that cannot fix a motion are reported as unsolved", "[pose][refinement]") {
  generated::Problem problem = drive();
  quadedge::PoseConfig config;
  problem.quads = 1;
  const auto one = generated::generate(problem, 34);
  CHECK_FALSE(refined_by(one.quads, problem.rig, config, problem.motion).solved);
  const QuadObservations none;
  CHECK_FALSE(refined_by(none, problem.rig, config, problem.motion).solved);
}

TEST_CASE("Perturbing is a rotation followed by a shift", "[pose][refinement]") {
  generated::Random random(35);
  const Eigen::Isometry3d motion = random.motion(1.0, 2.0);
  Vector6d step;
  step << 0.1, -0.2, 0.3, 1, 2, 3;
  const Eigen::Isometry3d moved = perturb(step, motion);
  const Eigen::AngleAxisd turn(step.head<3>().norm(), step.head<3>().normalized());
  const Eigen::Vector3d p(1, -2, 4);
  CHECK((moved * p - (turn * (motion * p) + step.tail<3>())).norm() < 1e-12);
}

namespace {

/// Quads of a drive as a rig sees them whose right principal point lies `offset` px beside what the calibration says.
QuadObservations quads_with_offset(const generated::Problem& problem, double offset, std::uint64_t seed) {
  quadedge::StereoRig seeing = problem.rig;
  seeing.right.cx += offset;
  generated::Random random(seed);
  QuadObservations quads;
  while (static_cast<int>(quads.size()) < problem.quads) {
    const auto p = generated::random_point(problem.rig, problem.near, problem.far, random);
    const OrientedPoint moved{problem.motion * p.point, problem.motion.linear() * p.tangent};
    if (moved.point.z() < 0.5 * problem.near) continue;
    const auto before = generated::disturb(seeing, p, problem.noise, true, random);
    const auto after = generated::disturb(seeing, moved, problem.noise, false, random);
    quads.append(problem.rig, before, after, 1.0f, 0, static_cast<int>(quads.size()), generated::limits());
  }
  return quads;
}

}  // namespace

TEST_CASE("An offset of all disparities makes the motion too long until it is fitted", "[pose][refinement]") {
  generated::Problem problem = drive();
  problem.quads = 3000;
  quadedge::PoseConfig config;
  const double length = problem.motion.translation().norm();
  for (const double offset : {0.3, -0.2}) {
    const auto quads = quads_with_offset(problem, offset, 41);
    const Refined plain = refined_by(quads, problem.rig, config, problem.motion);
    const Refined fitted = refined_by(quads, problem.rig, config, problem.motion, 0.3 * 0.3);
    REQUIRE(plain.solved);
    CHECK(plain.offset == 0);
    // Disparities that are too small by the offset make everything, and the way, look longer.
    CHECK((plain.current_from_previous.translation().norm() - length) * offset > 0);
    // By more than what it adds to the nearest points.
    const double largest_disparity = problem.rig.left.fx * problem.rig.baseline() / problem.near;
    CHECK(std::abs(plain.current_from_previous.translation().norm() / length - 1) >
          std::abs(offset) / largest_disparity);
    CHECK(fitted.offset == Approx(offset).margin(4 * std::sqrt(fitted.offset_variance)));
    CHECK(fitted.offset_variance < 0.05 * 0.05);
    CHECK(std::abs(fitted.current_from_previous.translation().norm() / length - 1) < 0.002);
    const Vector6d error = error_of(fitted.current_from_previous, problem.motion);
    CHECK(error.dot(fitted.covariance.ldlt().solve(error)) <
          22.5);  // 99.9 % of a chi-squared distribution with 6 degrees
  }
}

TEST_CASE("A standing camera says nothing about the disparities' offset", "[pose][refinement]") {
  generated::Problem problem = drive();
  problem.motion = Eigen::Isometry3d::Identity();
  quadedge::PoseConfig config;
  const auto quads = quads_with_offset(problem, 0.3, 43);
  const Refined fitted = refined_by(quads, problem.rig, config, problem.motion, 0.3 * 0.3);
  REQUIRE(fitted.solved);
  CHECK(fitted.offset_variance > 0.9 * 0.3 * 0.3);
  CHECK(std::abs(fitted.offset) < 0.1);
  CHECK(fitted.current_from_previous.translation().norm() < 0.01);
}
