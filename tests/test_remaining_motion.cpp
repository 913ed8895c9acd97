#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "motion/acceptance.hpp"
#include "motion/remaining_motion.hpp"

using namespace quadedge;

namespace {

/// Stereo edges in front of a car's cameras that move by one of two motions, all matched correctly.
struct TwoMotions {
  Config config;
  StereoRig rig = generated::car_rig();
  motion::DisparityOffset offset{rig, config.pose};
  motion::StepBuilder steps{config, offset};
  std::shared_ptr<frontend::Rig> before = std::make_shared<frontend::Rig>(), now = std::make_shared<frontend::Rig>();
  motion::MotionQuery query;
  motion::StepHandle confirmed;

  /// `first` edges move by the confirmed motion, `others` by another one.
  TwoMotions(const Eigen::Isometry3d& motion, int first, const Eigen::Isometry3d& other, int others) {
    before->start(0);
    now->start(1);
    generated::Random random(3);
    const generated::Noise noise{0.1, 0.1, 0.02};
    for (int i = 0; i < first + others; ++i) {
      const auto p = generated::random_point(rig, 5, 25, random);
      const Eigen::Isometry3d& m = i < first ? motion : other;
      generated::append(before->edges, generated::disturb(rig, p, noise, true, random));
      generated::append(now->edges, generated::disturb(rig, {m * p.point, Eigen::Vector3d(m.linear() * p.tangent)},
                                                       noise, false, random));
    }
    query.current = now;
    query.base = before;
    query.seed = 5;
    confirmed = steps.take(query.base);
    for (int i = 0; i < first + others; ++i) confirmed->matches.append(i, i, now->edges, 0.9F, 0);
    steps.estimate(query, config.pose, motion, *confirmed);
    confirmed->motion.current_from_previous = motion;
    motion::Acceptance(config, offset).judge({before->edges.left_x, before->edges.left_y, {}}, *confirmed);
  }

  motion::StepHandle propose() {
    motion::RemainingMotion hypothesis(steps, config);
    motion::Evidence evidence;
    evidence.confirmed = confirmed.get();
    return hypothesis.propose(query, evidence);
  }
};

Eigen::Isometry3d sideways(double metres) { return Eigen::Isometry3d(Eigen::Translation3d(metres, 0, 0)); }

}  // namespace

TEST_CASE("remaining motion: edges that the confirmed motion does not explain give another motion", "[odometry]") {
  // At a depth of 10 m, 0.03 m are 2 px.
  TwoMotions edges(sideways(0.2), 400, sideways(0.17), 300);
  const auto step = edges.propose();
  REQUIRE(step);
  REQUIRE(step->ok());
  CHECK(step->base == edges.query.base);
  CHECK((step->motion.current_from_previous.translation() - sideways(0.17).translation()).norm() < 0.003);
  // Only the remaining edges: hardly any of the first motion, and most of the others.
  CHECK(std::count_if(step->matches.previous.begin(), step->matches.previous.end(), [](int i) { return i < 400; }) <
        40);
  CHECK(step->matches.size() > 200);
}

TEST_CASE("remaining motion: there is none if the confirmed motion explains everything", "[odometry]") {
  TwoMotions edges(sideways(0.2), 700, sideways(0.2), 0);
  const auto step = edges.propose();
  REQUIRE(step);
  CHECK_FALSE(step->ok());
  edges.confirmed.reset();
  CHECK(edges.propose() == nullptr);
}

TEST_CASE("remaining motion: a motion since the key rig is converted to one since the base", "[odometry]") {
  TwoMotions edges(sideways(0.2), 400, sideways(0.17), 300);
  const auto base = std::make_shared<frontend::Rig>();
  edges.query.key = edges.query.base;
  edges.query.base = base;
  edges.query.base_from_key = sideways(0.05);
  const auto step = edges.propose();
  REQUIRE(step);
  REQUIRE(step->ok());
  CHECK(step->base == base);
  CHECK((step->motion.current_from_previous.translation() - sideways(0.12).translation()).norm() < 0.003);
}
