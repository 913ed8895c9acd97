#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "motion/still_camera.hpp"

using namespace quadedge;

TEST_CASE("still camera: zero motion since the base is always proposed", "[odometry]") {
  const Config config;
  const StereoRig rig = generated::car_rig();
  const motion::DisparityOffset offset{rig, config.pose};
  motion::StepBuilder steps{config, offset};
  motion::StillCamera hypothesis(steps);
  motion::MotionQuery query;
  query.base = std::make_shared<frontend::Rig>();
  query.current = std::make_shared<frontend::Rig>();
  query.prediction = Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3));

  // A reused step from the pool is reset.
  steps.take(query.base)->motion.current_from_previous = *query.prediction;
  const auto used = steps.take(query.base);
  used->motion.current_from_previous = *query.prediction;
  motion::Evidence nothing, found;
  found.confirmed = found.global_matches = used.get();
  for (const motion::Evidence* evidence : {&nothing, &found}) {
    const auto step = hypothesis.propose(query, *evidence);
    REQUIRE(step);
    CHECK(step->ok());
    CHECK(step->base == query.base);
    CHECK(step->motion.current_from_previous.matrix() == Eigen::Matrix4d::Identity());
    CHECK(step->matches.size() == 0);
  }
}
