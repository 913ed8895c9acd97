#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "motion/pose_constants.hpp"
#include "motion/sample_fit.hpp"

using namespace quadedge::pose;

namespace {

struct Sample {
  explicit Sample(const generated::Problem& problem) : quads(generated::generate(problem, 70).quads) {
    const NoiseModel noise{quadedge::PoseConfig{}};
    for (std::size_t i = 0; i < quads.size(); ++i) {
      terms.push_back(make_sample_term(quads, i, noise, problem.rig.left));
      rows.push_back(static_cast<std::int32_t>(i));
    }
  }
  QuadObservations quads;
  std::vector<SampleTerm> terms;
  std::vector<std::int32_t> rows;
};

generated::Problem drive() {
  generated::Problem problem;
  problem.motion.linear() = Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.1, 1, 0.1).normalized()).toRotationMatrix();
  problem.motion.translation() << 0.05, 0.02, -1.2;
  return problem;
}

}  // namespace

TEST_CASE("A few exact quads give the exact motion, two of them through their directions", "[pose][sample_fit]") {
  generated::Random random(71);
  const quadedge::PoseConfig config;
  for (int count : {2, 3, 8}) {
    generated::Problem problem = drive();
    problem.quads = count;
    const Sample sample(problem);
    Eigen::Isometry3d pose = random.motion(1e-4, 0.002) * problem.motion;
    SampleWorkspace workspace;
    for (int fit = 0; fit < 4; ++fit) {  // exact quads converge slowly: the scale shrinks with each step
      REQUIRE(fit_sample(sample.terms, sample.rows, config, pose, workspace));
    }
    CHECK(generated::rotation_error(pose, problem.motion) < 1e-6);
    CHECK(generated::translation_error(pose, problem.motion) < 1e-4);
  }
}

TEST_CASE("An empty sample has no fit and leaves the pose unchanged", "[pose][sample_fit]") {
  const generated::Problem problem = drive();
  const Sample sample(problem);
  Eigen::Isometry3d pose = problem.motion;
  SampleWorkspace workspace;
  CHECK_FALSE(fit_sample(sample.terms, {}, quadedge::PoseConfig{}, pose, workspace));
  CHECK(pose.matrix() == problem.motion.matrix());
}
