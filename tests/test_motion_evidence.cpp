#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "generated_quads.hpp"
#include "motion/motion_evidence.hpp"

using namespace quadedge;
using odometry::MotionEvidence;
using odometry::MotionStep;

namespace {

/// A step whose quads come from two motions; the base's edges are predicted at the quads' current positions.
struct TwoMotions {
  MotionStep step;
  EdgePositions predicted;

  TwoMotions(const generated::Problem& first, const generated::Problem& second) {
    step.quads = generated::generate(first, 1).quads;
    generated::append(step.quads, generated::generate(second, 2).quads);
    step.quads.match.resize(step.quads.size());
    std::iota(step.quads.match.begin(), step.quads.match.end(), 0);
    step.matches.previous = step.quads.match;
    predicted.x = step.quads.scoring.left_x;
    predicted.y = step.quads.scoring.left_y;
    step.motion.inliers = static_cast<int>(step.quads.size());
  }
  double area_of(const Eigen::Isometry3d& motion) {
    const Config config;
    step.motion.current_from_previous = motion;
    step.verdict = {};
    step.verdict.refusal = odometry::Refusal::none;
    MotionEvidence(config, generated::car_rig()).judge(predicted, Config().temporal.min_support, step);
    return step.verdict.area;
  }
};

Eigen::Isometry3d shift(double x, double z) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = Eigen::Vector3d(x, 0, z);
  return motion;
}

/// An object 8 m away that moves to the right, over a ratio of the image's width.
generated::Problem thing_of(int quads, double width_ratio) {
  generated::Problem thing;
  thing.quads = quads;
  thing.width_ratio = width_ratio;
  thing.motion = shift(0.6, 0);
  thing.near = thing.far = 8;
  return thing;
}

/// The scene behind it, seen from a camera that drives on.
generated::Problem scene_of(int quads) {
  generated::Problem scene;
  scene.quads = quads;
  scene.motion = shift(0, -1);
  return scene;
}

}  // namespace

TEST_CASE("motion evidence: an object counts by its area in the image, not by its number of edges", "[odometry]") {
  generated::Problem thing = thing_of(600, 0.1), scene = scene_of(300);
  TwoMotions seen(thing, scene);
  const double thing_area = seen.area_of(thing.motion), scene_area = seen.area_of(scene.motion);
  CHECK(thing_area > 0.05);
  CHECK(thing_area < 0.3);
  CHECK(scene_area > 0.7);
  CHECK(scene_area < 1);
  CHECK(seen.area_of(shift(3, 3)) < 0.05);
}

TEST_CASE("motion evidence: the moving ratio is a fraction of the image, and motions differ by the quads they share",
          "[odometry]") {
  generated::Problem thing = thing_of(600, 0.1), scene = scene_of(300);
  TwoMotions seen(thing, scene);
  // Two thirds of the edges belong to the object, where few edges move with the scene; one third belongs to the scene.
  seen.area_of(scene.motion);
  CHECK(seen.step.verdict.moving_ratio > 0.5);
  seen.area_of(thing.motion);
  CHECK(seen.step.verdict.moving_ratio > 0.2);
  CHECK(seen.step.verdict.moving_ratio < 0.4);

  thing.motion = scene.motion;
  TwoMotions alike(thing, scene);
  alike.area_of(scene.motion);
  CHECK(alike.step.verdict.moving_ratio < 0.02);

  const Config config;
  MotionEvidence evidence(config, generated::car_rig());
  alike.step.motion.inlier.assign(alike.step.quads.size(), 1);
  CHECK(evidence.is_same_motion(alike.step, shift(0.005, 0) * scene.motion));
  CHECK_FALSE(evidence.is_same_motion(alike.step, shift(0.6, 0)));
}

TEST_CASE("motion evidence: points at rest contradict a motion: the camera may be at rest", "[odometry]") {
  generated::Problem thing, scene;
  thing.quads = 400;
  thing.motion = shift(0.3, 0);
  thing.near = thing.far = 8;
  scene.quads = 60;
  scene.motion = Eigen::Isometry3d::Identity();
  scene.near = 5;
  scene.far = 10;
  TwoMotions seen(thing, scene);
  seen.area_of(thing.motion);
  CHECK(seen.step.verdict.static_ratio > 0.1);
  seen.area_of(scene.motion);
  CHECK(seen.step.verdict.static_ratio < 0.01);
  // Points too far away to show the motion agree with it as well.
  scene.motion = thing.motion;
  scene.near = scene.far = 2000;
  TwoMotions far(thing, scene);
  far.area_of(thing.motion);
  CHECK(far.step.verdict.static_ratio < 0.01);
}

TEST_CASE("motion evidence: without enough support among the edges in view a motion is refused", "[odometry]") {
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

TEST_CASE("motion evidence: global matches confirm the motion that they follow", "[odometry]") {
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
