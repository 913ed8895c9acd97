#include "refinement_trials.hpp"

using namespace quadedge::pose;

TEST_CASE("With exact quads the refinement converges to the exact motion from a start nearby", "[pose]") {
  generated::Problem problem = generated::drive();
  problem.noise = {};
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    problem.rig = rig;
    const auto g = generated::generate(problem, 30);
    generated::Random random(31);
    quadedge::PoseConfig config;
    const auto refined = generated::refined_by(g.quads, rig, config, random.motion(3e-4, 0.005) * problem.motion);
    CHECK(refined.inliers == static_cast<int>(g.quads.size()));
    CHECK((refined.current_from_previous.matrix() - problem.motion.matrix()).norm() < 1e-9);
  }
}

TEST_CASE("Noisy earlier depths cause no bias along the motion, and the covariance is consistent", "[long][pose]") {
  generated::Problem problem = generated::drive();
  const generated::Trials trials = generated::run_trials(problem, 150);
  for (int k = 0; k < 6; ++k) CHECK(std::abs(trials.mean(k)) < 3.5 * trials.standard_error(k));
  CHECK(std::abs(trials.mean(5)) < 2e-4);  // of 1.2 m
  CHECK(trials.nees > 0.7);
  CHECK(trials.nees < 1.5);
}

TEST_CASE("Distant points with large disparity noise do not shorten the motion", "[long][pose]") {
  generated::Problem problem = generated::drive();
  problem.noise.across = 0.3;
  problem.near = 15;
  problem.far = 150;
  problem.quads = 1000;
  // If the earlier points were assumed exact, the mean would be off by 0.7 mm, five standard errors.
  const generated::Trials trials = generated::run_trials(problem, 120);
  CHECK(trials.standard_error(5) < 1.6e-4);
  CHECK(std::abs(trials.mean(5)) < 3.5 * trials.standard_error(5));
}

TEST_CASE("Edges detected at a fixed scale in an approaching scene do not shorten the motion", "[pose]") {
  generated::Problem problem = generated::drive();
  const auto& camera = problem.rig.left;
  const Eigen::Vector2d middle(camera.cx, camera.cy);
  const auto error = [&](bool with_drift) {
    generated::Random random(36);
    QuadObservations quads;
    while (quads.size() < 500) {
      const auto p = generated::random_point(problem.rig, problem.near, problem.far, random);
      const OrientedPoint q{problem.motion * p.point, problem.motion.linear() * p.tangent};
      if (q.point.z() < 3) continue;
      auto before = generated::observe(problem.rig, p), after = generated::observe(problem.rig, q);
      // Every edge drifts outwards with the scale, so that it lags behind as the scene approaches; half of the growth
      // is applied at either time. The right edge drifts like the left one.
      const double growth = std::log(p.point.z() / q.point.z());
      const auto drift = [&](StereoObservation& o, double share) {
        const Eigen::Vector2d normal(-std::sin(o.left_direction), std::cos(o.left_direction));
        const double outwards = normal.dot(o.left - middle) > 0 ? 1.5 : -1.5;
        const double depth = (&o == &before ? p : q).point.z();
        o.left += share * growth * outwards * normal;
        o.right = problem.rig.right.project(problem.rig.right_from_left * (depth * camera.ray(o.left)));
        if (with_drift) o.left_scale_shift = outwards;
      };
      drift(before, 0.5);
      drift(after, -0.5);
      generated::append(quads, problem.rig, before, after, 1.0f);
    }
    const auto refined = generated::refined_by(quads, problem.rig, {}, problem.motion);
    return generated::error_of(refined.current_from_previous, problem.motion).tail<3>().norm();
  };
  CHECK(error(false) > 2e-3);  // of 1.2 m
  CHECK(error(true) < 0.1 * error(false));
}

TEST_CASE("Wrong quads among the inliers hardly affect the pose", "[pose]") {
  generated::Problem problem = generated::drive();
  problem.quads = 1000;
  quadedge::PoseConfig robust, plain;
  plain.student_dof = 1e9;  // a normal distribution: plain least squares
  // 15 % of the quads are one pixel off to one side: within an inlier's 1.5 px, but seven standard deviations off.
  const auto quads = generated::changed_quads(problem, 33, [](int i, StereoObservation&, StereoObservation& after) {
    if (i % 7 == 0) after.left.x() += 1.0, after.right.x() += 1.0;
    return true;
  });
  const auto error = [&](const quadedge::PoseConfig& config) {
    const auto refined = generated::refined_by(quads, problem.rig, config, problem.motion);
    return generated::error_of(refined.current_from_previous, problem.motion).head<3>().norm();
  };
  // A plain mean would rotate by about 0.14 px / 700 px = 2e-4 rad.
  CHECK(error(plain) > 1.5e-4);
  CHECK(error(robust) < 0.6 * error(plain));
}

TEST_CASE("Quads that do not determine a motion are reported as unsolved", "[pose]") {
  generated::Problem problem = generated::drive();
  quadedge::PoseConfig config;
  problem.quads = 1;
  RefinementWorkspace workspace;
  for (const QuadObservations& quads : {generated::generate(problem, 34).quads, QuadObservations()}) {
    MotionEstimate motion;
    motion.current_from_previous = problem.motion;
    CHECK_FALSE(refine(quads, problem.rig, config, 0, workspace, motion));
  }
}

TEST_CASE("The scale of errors is their median over the expected one, never zero", "[pose]") {
  std::vector<double> values;
  CHECK(measured_scale({8, 2, 1e9, 4, 3}, 5, 2.0, values) == 2.0);
  CHECK(measured_scale({8, 2, 6, 4, 3}, 3, 2.0, values) == 3.0);  // only the first three
  CHECK(measured_scale({0, 0, 0}, 3, 2.0, values) == kSmallestScale);
}
