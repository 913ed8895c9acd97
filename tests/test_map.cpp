#include "saved_maps.hpp"
#include "scene_corridor.hpp"

using namespace quadedge;
using saved_maps::small;

namespace {

/// One stereo frame of a visit, and where it was taken; each scene has a world of its own.
struct Shot {
  std::string scene;  ///< empty: black images
  Image left, right;
  Eigen::Isometry3d world_from_left;
};

/// Appends frames first, first + step ... up to last.
void visit(const SyntheticOptions& options, int first, int last, int step, std::vector<Shot>& shots) {
  const SyntheticSequence sequence(options);
  for (int i = first; step > 0 ? i <= last : i >= last; i += step)
    shots.push_back({options.scene, sequence.render(i, Side::left).image, sequence.render(i, Side::right).image,
                     sequence.world_from_left(i)});
}

void black(int count, std::vector<Shot>& shots) {
  for (int i = 0; i < count; ++i) shots.push_back({"", Image(320, 200), Image(320, 200), {}});
}

struct Outcome {
  std::vector<FrameResult> results;
  std::vector<Closure> closures;
  std::size_t most_at_once = 0, in_the_end = 0;  ///< comparisons that one frame ended, and finish()
  Trajectory trajectory;
  Eigen::Isometry3d map_from_odometry;
  int segments = 0;

  int kept() const {
    int count = 0;
    for (const Closure& closure : closures) count += closure.verdict == ClosureVerdict::kept ? 1 : 0;
    return count;
  }
};

Config with_gap(int gap) {
  Config config;
  config.map.min_gap = gap;
  return config;
}

/// Tracks all shots, on the first device. \param with_map otherwise the odometry alone
Outcome track(const std::vector<Shot>& shots, const Config& config, bool with_map = true) {
  const SyntheticSequence any(small("room", "loop", 10));
  StereoOdometry odometry(any.rig(), config);
  std::unique_ptr<Map> map;
  if (with_map) map = std::make_unique<Map>(odometry);
  Outcome outcome;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto stamp = static_cast<std::int64_t>(i) * 50'000'000;
    outcome.results.push_back(odometry.track({stamp, shots[i].left.view(), shots[i].right.view()}));
    if (!map) continue;
    const std::size_t before = map->closures().size();
    map->add(outcome.results.back());
    outcome.most_at_once = std::max(outcome.most_at_once, map->closures().size() - before);
  }
  if (!map) return outcome;
  outcome.in_the_end = map->closures().size();
  map->finish();
  outcome.in_the_end = map->closures().size() - outcome.in_the_end;
  outcome.closures = map->closures();
  outcome.trajectory = map->trajectory();
  outcome.map_from_odometry = map->map_from_odometry();
  outcome.segments = map->segments();
  return outcome;
}

/// Every closure that was kept is right: within 5 cm + 10 % of the motion and 2 degrees.
void check_kept(const Outcome& outcome, const std::vector<Shot>& shots) {
  for (const Closure& closure : outcome.closures) {
    if (closure.verdict != ClosureVerdict::kept) continue;
    const Shot &now = shots[static_cast<std::size_t>(closure.frame)],
               &before = shots[static_cast<std::size_t>(closure.other)];
    INFO(closure.frame << " with " << closure.other);
    REQUIRE(now.scene == before.scene);
    const Eigen::Isometry3d truth = now.world_from_left.inverse() * before.world_from_left;
    const Eigen::Isometry3d error = *closure.frame_from_other * truth.inverse();
    CHECK(error.translation().norm() < 0.05 + 0.1 * truth.translation().norm());
    CHECK(Eigen::AngleAxisd(error.linear()).angle() < 2 * kDegree);
  }
}

}  // namespace

TEST_CASE("map: a loop is closed, and the odometry has the same poses without the map", "[device]") {
  std::vector<Shot> shots;
  for (int round = 0; round < 2; ++round) visit(small("room", "loop", 49), round, 48, 1, shots);
  const Outcome with = track(shots, with_gap(3)), without = track(shots, with_gap(3), false);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    CHECK(with.results[i].pose_or_prediction().matrix() == without.results[i].pose_or_prediction().matrix());
    CHECK(with.results[i].counts.inliers == without.results[i].counts.inliers);
  }
  check_kept(with, shots);
  REQUIRE(with.kept() > 0);
  REQUIRE(with.trajectory.size() == shots.size());
  // map_from_odometry leads from the odometry's pose to the map's.
  const Eigen::Isometry3d last = with.map_from_odometry * *with.results.back().world_from_left;
  CHECK((last.translation() - with.trajectory.back().world_from_left.translation()).norm() < 1e-9);
  const auto error = [&](const Eigen::Isometry3d& pose) { return pose.translation().norm(); };  // back at the start
  CHECK(error(last) <= error(*with.results.back().world_from_left));
  // The same frames give the same closures and poses.
  const Outcome again = track(shots, with_gap(3));
  REQUIRE(again.closures.size() == with.closures.size());
  for (std::size_t i = 0; i < with.closures.size(); ++i) {
    CHECK(again.closures[i].other == with.closures[i].other);
    CHECK(again.closures[i].inliers == with.closures[i].inliers);
  }
  for (std::size_t i = 0; i < with.trajectory.size(); ++i)
    CHECK(again.trajectory[i].world_from_left.matrix() == with.trajectory[i].world_from_left.matrix());
}

TEST_CASE("map: black frames, another place in other light, and back: the segments of one place are joined",
          "[device]") {
  std::vector<Shot> shots;
  visit(small("room", "ellipse", 60), 0, 24, 4, shots);
  black(5, shots);
  visit(small("cables", "ellipse", 60), 0, 24, 4, shots);
  const std::size_t away = shots.size();
  SyntheticOptions darker = small("room", "ellipse", 60);
  darker.light = 0.5;
  visit(darker, 20, 0, -4, shots);
  const Outcome outcome = track(shots, with_gap(10));
  check_kept(outcome, shots);
  CHECK(outcome.segments == 2);
  // The room's frames before and after lie in one frame, the first camera's.
  int after = 0;
  for (const StampedPose& pose : outcome.trajectory) {
    const auto number = static_cast<std::size_t>(pose.stamp_ns / 50'000'000);
    INFO(number);
    REQUIRE(shots[number].scene == "room");
    const Eigen::Isometry3d truth = shots[0].world_from_left.inverse() * shots[number].world_from_left;
    CHECK((pose.world_from_left.translation() - truth.translation()).norm() < 0.03);
    after += number >= away ? 1 : 0;
  }
  CHECK(after >= 5);
}

TEST_CASE("map: comparisons are spread over frames, and the rest is made in the end", "[device]") {
  std::vector<Shot> shots;
  visit(small("room", "ellipse", 60), 0, 56, 4, shots);
  black(5, shots);
  visit(small("cables", "ellipse", 60), 0, 12, 4, shots);
  visit(small("room", "ellipse", 60), 30, 22, -2, shots);
  const Outcome outcome = track(shots, with_gap(10));
  check_kept(outcome, shots);
  REQUIRE(outcome.closures.size() > 3);
  CHECK(outcome.most_at_once == 1);
  CHECK(outcome.in_the_end > 0);
}

TEST_CASE("map: neither a street driven once nor bays of a corridor with equal doors are taken for another place",
          "[device]") {
  struct Row {
    const char* scene;
    int gap, frames;
    std::optional<int> segments;
  };
  for (const Row& row : {Row{"facade", 10, 100, std::nullopt}, {"corridor", 3, 100, 1}, {"corridor", 3, 119, 3}}) {
    std::vector<Shot> shots;  // a bay is twelve frames long
    visit(small(row.scene, "drive", row.frames), 0, row.segments == 3 ? 48 : 99, 3, shots);
    if (row.segments == 3) {  // the second part of the corridor is reached unseen
      visit(small("room", "ellipse", 60), 0, 8, 4, shots);
      visit(small(row.scene, "drive", row.frames), 60, 108, 3, shots);
    }
    const Outcome outcome = track(shots, with_gap(row.gap));
    INFO(row.scene << ", " << row.frames);
    check_kept(outcome, shots);
    if (row.segments) CHECK(outcome.segments == *row.segments);
    if (row.segments == 3) CHECK(outcome.closures.size() > 0);
  }
}

TEST_CASE("map: what it cannot work with is a usage error") {
  const SyntheticSequence any(small("room", "loop", 10));
  Device reference("reference");
  Config config;
  config.temporal.global_edges = 0;
  StereoOdometry without_search(any.rig(), reference, config);
  CHECK_THROWS_AS(Map(without_search), UsageError);
  config = {};
  config.temporal.sift_max = 200;
  StereoOdometry with_sift(any.rig(), reference, config);
  CHECK_THROWS_AS(Map(with_sift), UsageError);
}

TEST_CASE("map: it has to see every frame from the first on", "[device]") {
  const SyntheticSequence sequence(small("room", "ellipse", 4));
  const auto track = [&](StereoOdometry& odometry, int frame) { return odometry.track(sequence.pair(frame).view()); };
  StereoOdometry odometry(sequence.rig());
  track(odometry, 0);
  CHECK_THROWS_AS(Map(odometry), UsageError);

  StereoOdometry other(sequence.rig());
  Map map(other);
  map.add(track(other, 0));
  track(other, 1);
  const FrameResult result = track(other, 2);  // against frame 0 or 1, of which the map knows one
  CHECK_THROWS_WITH(map.add(result), Catch::Matchers::Contains("frame 2 last, expected 1"));
  CHECK(map.trajectory().size() == 1);
}
