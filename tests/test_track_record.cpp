#include <catch2/catch.hpp>

#include "motion/track_record.hpp"

using namespace quadedge;

namespace {

/// \param is_checked that the rest of the image was searched for another motion
motion::MotionStep with(double support, bool is_checked = false) {
  motion::MotionStep step;
  step.motion.status = pose::MotionStatus::ok;
  step.verdict.support = support;
  step.is_checked = is_checked;
  return step;
}

}  // namespace

TEST_CASE("track record: the support required follows the support of recent motions", "[odometry]") {
  Config config;
  config.temporal.confident_support = 0.35;
  motion::TrackRecord record(config);
  // The configured support, until three searches found no other motion.
  for (int frame = 0; frame < 3; ++frame) {
    CHECK(record.confident_support() == 0.35);
    record.remember(with(0.5, true));
  }
  CHECK(record.confident_support() == Approx(0.25));
  for (int frame = 0; frame < 100; ++frame) record.remember(with(0.5));
  CHECK(record.confident_support() == Approx(0.25));
  record.remember(with(0.9));  // never requires more
  CHECK(record.confident_support() == 0.35);
  for (int frame = 0; frame < 100; ++frame) record.remember(with(0.1));
  CHECK(record.confident_support() == Approx(0.2));  // nor less than chance may reach
  record.remember(motion::MotionStep());             // lost
  CHECK(record.confident_support() == 0.35);
  for (int frame = 0; frame < 100; ++frame) record.remember(with(0.1));  // no search yet
  CHECK(record.confident_support() == 0.35);
  for (int frame = 0; frame < 3; ++frame) record.remember(with(0.1, true));
  CHECK(record.confident_support() == Approx(0.2));
}

TEST_CASE("track record: without a global search to ask, any support will do", "[odometry]") {
  Config config;
  config.temporal.wide_edges = 0;
  CHECK(motion::TrackRecord(config).confident_support() == 0);
}

TEST_CASE("track record: a doubt about the last motion is one about the prediction", "[odometry]") {
  motion::TrackRecord record{Config{}};
  CHECK_FALSE(record.is_doubtful());
  motion::MotionStep step = with(0.5);
  step.doubt = {motion::Ambiguity::static_scene, 0.1};
  record.remember(step);
  CHECK(record.is_doubtful());
  record.remember(with(0.5));
  CHECK_FALSE(record.is_doubtful());
}

TEST_CASE("track record: the rest of the image is checked at the start, now and then, and when more of it moves",
          "[odometry]") {
  const Config config;
  motion::TrackRecord record(config);
  motion::MotionStep step;
  step.motion.status = pose::MotionStatus::ok;
  const auto frames_until_check = [&](double moving_ratio) {
    step.verdict.moving_ratio = moving_ratio;
    for (int frame = 1;; ++frame) {
      step.is_checked = record.is_check_due(step.verdict);
      record.remember(step);
      if (step.is_checked || frame > 100) return frame;
    }
  };
  for (int frame = 0; frame < 3; ++frame) CHECK(frames_until_check(0.05) == 1);
  CHECK(frames_until_check(0.05) == 10);
  CHECK(frames_until_check(0.3) == 1);
  CHECK(frames_until_check(0.35) == 10);  // no more than at the last check
  // After a doubt, every frame until three of them were clear.
  step.doubt = {motion::Ambiguity::motion_elsewhere, 0.2};
  CHECK(frames_until_check(0.3) == 10);
  CHECK(frames_until_check(0.3) == 1);
  step.doubt = {};
  for (int frame = 0; frame < 3; ++frame) CHECK(frames_until_check(0.3) == 1);
  CHECK(frames_until_check(0.3) == 10);
  // After a loss.
  step.motion.status = pose::MotionStatus::no_consensus;
  step.is_checked = false;
  record.remember(step);
  step.motion.status = pose::MotionStatus::ok;
  CHECK(frames_until_check(0.3) == 1);
}
