#include "generated_quads.hpp"
#include "motion/motion_evidence.hpp"

using namespace quadedge;
using odometry::MotionEvidence;
using odometry::MotionStep;

namespace {

Eigen::Isometry3d shift(double x, double z) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = Eigen::Vector3d(x, 0, z);
  return motion;
}

}  // namespace

TEST_CASE("motion evidence: without enough support among the edges in view a motion is refused") {
  Config config;
  config.temporal.min_support = 0.06;
  MotionEvidence evidence(config, generated::car_rig());
  EdgePositions predicted;
  predicted.x.assign(100, 5.0f);
  predicted.x.resize(150, std::numeric_limits<float>::quiet_NaN());
  predicted.y.assign(150, 5.0f);
  MotionStep step;
  const auto refusal = [&](int inliers, odometry::Refusal of_estimate) {
    step.verdict.refusal = of_estimate;
    step.motion.inliers = inliers;
    evidence.judge(predicted, Config().temporal.min_support, step);
    CHECK(step.verdict.support == Approx(inliers / 100.0));
    return step.verdict.refusal;
  };
  CHECK(refusal(7, odometry::Refusal::none) == odometry::Refusal::none);
  CHECK(refusal(5, odometry::Refusal::none) == odometry::Refusal::little_support);
  CHECK(refusal(5, odometry::Refusal::too_few_quads) == odometry::Refusal::too_few_quads);
  CHECK(refusal(7, odometry::Refusal::badly_spread) == odometry::Refusal::badly_spread);
}

TEST_CASE("motion evidence: global matches confirm the motion that they follow") {
  const Config config;
  const MotionEvidence evidence(config, generated::car_rig());
  generated::Problem problem;
  problem.motion = shift(0.1, -0.9);
  problem.quads = 40;
  MotionStep global;
  odometry::Verdict verdict;
  global.quads = generated::generate(problem, 3).quads;
  global.motion.inlier.assign(global.quads.size(), 1);
  evidence.compare_globally(global, nullptr, problem.motion, verdict);
  CHECK(verdict.agrees_globally);
  CHECK(verdict.global_ratio > 0.9);
  CHECK(verdict.rival_ratio < 0.1);
  // What they leave may follow another motion: 20 quads of these, beside 40.
  generated::Problem other = problem;
  other.motion = shift(-1, 0.9);
  other.quads = 20;
  MotionStep rest;
  rest.quads = generated::generate(other, 5).quads;
  rest.motion.inlier.assign(rest.quads.size(), 1);
  evidence.compare_globally(global, &rest, problem.motion, verdict);
  CHECK(verdict.rival_ratio == Approx(0.5).margin(0.05));
  evidence.compare_globally(global, &rest, other.motion, verdict);
  CHECK_FALSE(verdict.agrees_globally);
  CHECK(verdict.rival_ratio > 10);
  // Neighbours on one curve count once.
  problem.quads = 1;
  problem.copies = 40;
  global.quads = generated::generate(problem, 4).quads;
  REQUIRE(global.quads.size() == 40);
  global.motion.inlier.assign(40, 1);
  evidence.compare_globally(global, nullptr, problem.motion, verdict);
  CHECK_FALSE(verdict.agrees_globally);
}
