#include "edges/range_follower.hpp"
#include "matching.hpp"

using namespace quadedge;
using namespace matching;
using frontend::RangeFollower;

namespace {

/// 640 x 480, disparities 60 px per metre of inverse depth; 30 px expected.
StereoRig rig_of_30_px() {
  StereoRig rig = flat_rig(640, 480, 600, 0.1);
  rig.max_disparity = 30;
  return rig;
}

constexpr int kLeftEdges = 2048;  // every eighth is a probe

/// Stereo edges with evenly spaced disparities between two limits, as far as `follower` searches for them.
StereoEdges edges_between(double smallest, double largest, const RangeFollower& follower, int count = kLeftEdges) {
  const DisparityProbe probe = follower.probe(count);
  StereoEdges edges;
  for (int i = 0; i < count; ++i) {
    const auto disparity = static_cast<float>(smallest + (largest - smallest) * ((i * 389) % count) / count);
    const bool is_probe = probe.step > 0 && i % probe.step == 0;
    if (disparity > (is_probe ? probe.max_disparity : follower.geometry().max_disparity)) continue;
    edges.left_index.push_back(i);
    edges.left_x.push_back(400);
    edges.left_y.push_back(240);
    edges.right_x.push_back(400 - disparity);
    edges.right_y.push_back(240);
  }
  return edges;
}

/// Range of a frame of such edges; `searches` receives how often it was searched.
double follow(RangeFollower& follower, double largest, int& searches) {
  follower.start_frame();
  searches = 1;
  while (!follower.suffices(edges_between(0, largest, follower), kLeftEdges)) ++searches;
  return follower.disparity();
}

}  // namespace

TEST_CASE("range follower: a near wall with few edges widens the range, though little else than probes is found") {
  RangeFollower follower(rig_of_30_px(), Config{});
  constexpr int kFew = 120;
  const auto wall = [&] { return edges_between(80, 100, follower, kFew); };
  follower.start_frame();
  REQUIRE(wall().size() == 15);
  CHECK_FALSE(follower.suffices(wall(), kFew));
  CHECK(follower.disparity() > 100);
  CHECK(wall().size() == kFew);
  CHECK(follower.suffices(wall(), kFew));
}

TEST_CASE("range follower: near objects widen the range in the frame in which they appear") {
  RangeFollower follower(rig_of_30_px(), Config{});
  int searches = 0;
  CHECK(follow(follower, 90, searches) > 90);
  CHECK(searches == 2);
  CHECK(follow(follower, 90, searches) > 90);
  CHECK(searches == 1);
  CHECK(follow(follower, 1000, searches) == Approx(320));  // the limit: half the width
}

TEST_CASE("range follower: objects that come nearer slowly never cause a second search") {
  RangeFollower follower(rig_of_30_px(), Config{});
  int searches = 0;
  for (double largest = 5; largest < 200; largest *= 1.02) {
    CHECK(follow(follower, largest, searches) >= largest);
    CHECK(searches == 1);
  }
}

TEST_CASE("range follower: the range shrinks by a tenth per frame where nothing is near") {
  StereoRig rig = rig_of_30_px();
  rig.max_disparity = 0;  // that of 0.5 m: 120 px
  RangeFollower follower(rig, Config{});
  int searches = 0;
  double last = follow(follower, 20, searches);
  CHECK(last == Approx(120));
  for (int frame = 0; frame < 30; ++frame) {
    const double range = follow(follower, 20, searches);
    CHECK(range > 0.899 * last);
    CHECK(searches == 1);
    last = range;
  }
  CHECK(last < 70);
  CHECK(last > 40);
}

TEST_CASE("range follower: a range in the configuration is kept") {
  Config config;
  config.stereo.max_disparity = 20;
  RangeFollower follower(rig_of_30_px(), config);
  int searches = 0;
  CHECK(follower.probe(kLeftEdges).step == 0);
  CHECK(follow(follower, 100, searches) == Approx(20));
  CHECK(searches == 1);
  StereoRig absurd = rig_of_30_px();
  absurd.max_disparity = 1e6;
  CHECK_THROWS_AS(RangeFollower(absurd, Config{}), DataError);
}
