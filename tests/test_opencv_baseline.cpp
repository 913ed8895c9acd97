#include "../bench/opencv_baseline.hpp"
#include "testing.hpp"

using namespace quadedge;

namespace {

struct Tracked {
  Trajectory estimate, truth;
  std::vector<bench::BaselineResult> results;
};

/// The first frames of the rendered room, small; `black`: the number of a black frame.
Tracked track_room(int frames, int black = -1) {
  auto options = rendering(480, 300, 276, frames, 3);
  options.baseline = 0.12;
  const SyntheticSequence sequence(options);
  bench::OpencvBaseline baseline(sequence.rig());
  Tracked tracked;
  for (int i = 0; i < frames; ++i) {
    StereoPair pair = sequence.pair(i);
    if (i == black) pair.left = pair.right = Image(options.width, options.height);
    tracked.results.push_back(baseline.track(pair.view()));
    tracked.truth.push_back({pair.stamp_ns, sequence.world_from_left(i)});
    if (tracked.results.back().tracked)
      tracked.estimate.push_back({pair.stamp_ns, tracked.results.back().world_from_left});
  }
  return tracked;
}

}  // namespace

TEST_CASE("OpenCV baseline: tracks the rendered room", "[baseline]") {
  const Tracked tracked = track_room(5), again = track_room(5);
  REQUIRE(tracked.estimate.size() == 5);
  CHECK(tracked.results[0].world_from_left.matrix() == Eigen::Matrix4d::Identity());
  // Steps are 2 to 3 cm: a few percent of them.
  const auto errors = evaluate_trajectory(tracked.estimate, tracked.truth).origin_aligned;
  CHECK(errors.rpe_translation_m.max < 2e-3);
  CHECK(errors.rpe_rotation_deg.max < 0.05);
  for (std::size_t i = 1; i < 5; ++i) {
    CHECK(tracked.results[i].inliers > 100);
    CHECK(tracked.results[i].inliers <= tracked.results[i].matches);
    CHECK(tracked.results[i].world_from_left.matrix() == again.results[i].world_from_left.matrix());
  }
}

TEST_CASE("OpenCV baseline: a black frame is lost, and tracking resumes after the next frame", "[baseline]") {
  const Tracked tracked = track_room(5, 2);
  CHECK_FALSE(tracked.results[2].tracked);
  CHECK_FALSE(tracked.results[3].tracked);  // the previous frame has no points
  CHECK(tracked.results[4].tracked);
  CHECK(tracked.estimate.size() == 3);
}

TEST_CASE("OpenCV baseline: a rig without a baseline is refused", "[baseline]") {
  StereoRig rig;
  rig.left = rig.right = {100, 100, 50, 50, 100, 100};
  CHECK_THROWS_AS(bench::OpencvBaseline(rig), DataError);
}
