#include <catch2/catch.hpp>

#include "odometry/track_record.hpp"

using namespace quadedge;

namespace {

odometry::MotionStep with(double support) {
  odometry::MotionStep step;
  step.motion.status = pose::MotionStatus::ok;
  step.verdict.support = support;
  return step;
}

}  // namespace

TEST_CASE("track record: the support required follows the support of recent motions", "[odometry]") {
  Config config;
  config.temporal.confident_support = 0.35;
  odometry::TrackRecord record(config);
  CHECK(record.confident_support() == 0.35);  // before the first motion
  for (int frame = 0; frame < 100; ++frame) record.remember(with(0.5));
  CHECK(record.confident_support() == Approx(0.25));
  record.remember(with(0.9));  // never requires more
  CHECK(record.confident_support() == 0.35);
  for (int frame = 0; frame < 100; ++frame) record.remember(with(0.1));
  CHECK(record.confident_support() == Approx(0.2));  // nor less than chance may reach
  record.remember(odometry::MotionStep());           // lost
  CHECK(record.confident_support() == 0.35);
}

TEST_CASE("track record: without a global search to ask, any support will do", "[odometry]") {
  Config config;
  config.temporal.wide_edges = 0;
  CHECK(odometry::TrackRecord(config).confident_support() == 0);
}

TEST_CASE("track record: a doubt about the last motion is one about the prediction", "[odometry]") {
  odometry::TrackRecord record{Config{}};
  CHECK_FALSE(record.is_doubtful());
  odometry::MotionStep step = with(0.5);
  step.doubt = {odometry::Ambiguity::static_scene, 0.1};
  record.remember(step);
  CHECK(record.is_doubtful());
  record.remember(with(0.5));
  CHECK_FALSE(record.is_doubtful());
}
