#include "generated_quads.hpp"
#include "motion/motion.hpp"

using namespace quadedge::pose;

namespace {

MotionEstimate estimate_motion(const quadedge::StereoRig& rig, const QuadObservations& quads,
                               const quadedge::PoseConfig& config, std::uint64_t seed,
                               const std::optional<Eigen::Isometry3d>& initial = std::nullopt,
                               Refusal expected = Refusal::none) {
  MotionEstimate motion;
  REQUIRE(MotionEstimator().estimate(rig, quads, config, seed, initial, 0, motion) == expected);
  return motion;
}

const quadedge::PoseConfig kConfig;

}  // namespace

TEST_CASE("Exact quads give the motion to 1e-9, on a rectified and on a general rig", "[pose]") {
  generated::Random random(50);
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    for (int trial = 0; trial < 5; ++trial) {
      generated::Problem problem;
      problem.rig = rig;
      problem.near = 2;
      problem.far = 30;
      problem.quads = 200;
      problem.motion = random.motion(0.1, 0.8);
      const auto g = generated::generate(problem, 51);
      const MotionEstimate found = estimate_motion(rig, g.quads, kConfig, 42);
      CHECK(found.inliers == 200);
      CHECK(found.inlier_ratio() == 1.0);
      CHECK(generated::rotation_error(found.current_from_previous, problem.motion) < 1e-9);
      CHECK(generated::translation_error(found.current_from_previous, problem.motion) < 1e-9);
    }
  }
}

TEST_CASE("70 % outliers are separated from the inliers", "[pose]") {
  generated::Problem problem = generated::drive({0.12, 0.3, 0.02});
  problem.quads = 1500;
  problem.outliers = 0.7;
  const auto g = generated::generate(problem, 53);
  const MotionEstimate found = estimate_motion(problem.rig, g.quads, kConfig, 42);
  CHECK(generated::rotation_error(found.current_from_previous, problem.motion) < 1.5e-4);
  CHECK(generated::translation_error(found.current_from_previous, problem.motion) < 3e-3);
  int correct = 0, agreed = 0, intruders = 0;
  for (std::size_t i = 0; i < g.correct.size(); ++i) {
    correct += g.correct[i];
    agreed += g.correct[i] && found.inlier[i];
    intruders += !g.correct[i] && found.inlier[i];
  }
  CHECK(agreed > 0.8 * correct);
  CHECK(intruders < 0.02 * correct);
  CHECK(found.inlier_ratio() == Approx(static_cast<double>(found.inliers) / 1500));
}

TEST_CASE("Without the refinement the consensus pose has no covariance", "[pose]") {
  generated::Problem problem = generated::drive({0.12, 0.4, 0.02});
  problem.quads = 3000;
  const auto g = generated::generate(problem, 54);
  quadedge::PoseConfig plain;
  plain.refine = false;
  const MotionEstimate coarse = estimate_motion(problem.rig, g.quads, plain, 42);
  const MotionEstimate fine = estimate_motion(problem.rig, g.quads, kConfig, 42);
  CHECK(coarse.learned.covariance.isZero());
  CHECK(fine.learned.covariance.ldlt().isPositive());
  CHECK((fine.learned.covariance - fine.learned.covariance.transpose()).isZero());
  CHECK(generated::rotation_error(coarse.current_from_previous, problem.motion) < 5e-4);
  CHECK(coarse.current_from_previous.matrix() != fine.current_from_previous.matrix());
}

TEST_CASE("An unreliable result has a status and no pose", "[pose]") {
  generated::Problem problem = generated::drive({});
  for (int count : {0, 1, 2, 11}) {
    problem.quads = count;
    const auto g = generated::generate(problem, 55);
    const MotionEstimate found =
        estimate_motion(problem.rig, g.quads, kConfig, 42, std::nullopt, Refusal::too_few_quads);
    CHECK(found.current_from_previous.matrix() == Eigen::Matrix4d::Identity());
    CHECK(found.inlier.size() == static_cast<std::size_t>(count));
  }
  problem.quads = 300;
  problem.outliers = 1.0;
  estimate_motion(problem.rig, generated::generate(problem, 56).quads, kConfig, 42, std::nullopt,
                  Refusal::no_consensus);

  // All quads in one corner: samples need a minimum distance, so the search gets the true motion as a guess.
  problem.outliers = 0;
  generated::Random random(57);
  QuadObservations corner, spot;
  for (int i = 0; i < 300; ++i) {
    OrientedPoint p = generated::random_point(problem.rig, 5, 50, random);
    p.point = p.point.z() * problem.rig.left.ray({random.uniform(300, 380), random.uniform(40, 120)});
    const auto add = [&](QuadObservations& quads) {
      const OrientedPoint q{problem.motion * p.point, problem.motion.linear() * p.tangent};
      generated::append(quads, problem.rig, generated::observe(problem.rig, p), generated::observe(problem.rig, q),
                        1.0f);
    };
    add(corner);
    p.point = Eigen::Vector3d(1, 0.5, 12);
    add(spot);
  }
  REQUIRE(corner.size() > 200);
  REQUIRE(spot.size() > 200);
  for (const QuadObservations* quads : {&corner, &spot}) {
    const MotionEstimate found =
        estimate_motion(problem.rig, *quads, kConfig, 42, problem.motion, Refusal::badly_spread);
    CHECK(found.current_from_previous.matrix() == Eigen::Matrix4d::Identity());
    CHECK(found.learned.covariance.isZero());
    MotionEstimate unguided;
    CHECK(MotionEstimator().estimate(problem.rig, *quads, kConfig, 42, std::nullopt, 0, unguided) != Refusal::none);
  }
}
