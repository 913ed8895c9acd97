#include "own_camera.hpp"

using Catch::Matchers::Contains;
using namespace quadedge;

namespace {

/// The rendered room, tracked; every frame is a keyframe, so that a few frames make a map.
struct TrackedRoom {
  SyntheticSequence sequence;
  Config config;
  std::vector<StereoPair> pairs;
  TrackedRoom() : sequence(rendering(480, 300, 541.764 * 480.0 / 942, 6, 4)) {
    config.odometry.key_rig = false;
    for (int i = 0; i < sequence.frames(); ++i) pairs.push_back(sequence.pair(i));
  }
  void track_into(const std::vector<PointCloud*>& maps) const {
    Device device("auto", kept_programs());
    StereoOdometry odometry(sequence.rig(), device, config);
    for (const StereoPair& pair : pairs) {
      const FrameResult result = odometry.track(pair.view());
      for (PointCloud* map : maps) map->add(pair.view(), result, odometry);
    }
  }
};

const TrackedRoom& tracked_room() {
  static const TrackedRoom all;
  return all;
}

PointCloudOptions seen_by(int views, std::size_t most = 2'000'000) {
  PointCloudOptions options;
  options.min_views = views;
  options.most_points = most;
  return options;
}

/// Relative depth errors of points in the first view against the rendered depth, as sorted magnitudes.
std::vector<double> depth_errors(const std::vector<CloudPoint>& points) {
  const auto depth = tracked_room().sequence.render(0, Side::left).depth;
  const PinholeCamera& camera = tracked_room().sequence.rig().left;
  std::vector<double> errors;
  for (const auto& point : points) {
    const Eigen::Vector2d pixel = camera.project(point.position);
    double nearest = 1e9;  // an occluding edge belongs to the nearer surface, about a pixel away
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const auto x = std::lround(pixel.x()) + dx, y = std::lround(pixel.y()) + dy;
        if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) continue;
        const double truth = static_cast<double>(depth[static_cast<std::size_t>(y * camera.width + x)]);
        if (truth > 0) nearest = std::min(nearest, std::abs(point.position.z() / truth - 1));
      }
    }
    if (nearest < 1e9) errors.push_back(nearest);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

}  // namespace

TEST_CASE("points: points lie on the rendered surfaces, the closer the more rigs have seen them", "[device]") {
  PointCloud once(tracked_room().config, seen_by(1)), twice(tracked_room().config, seen_by(2)),
      often(tracked_room().config, seen_by(5));
  tracked_room().track_into({&once, &twice, &often});
  CHECK(once.views().size() == 6);
  CHECK(once.views()[5].frame == 5);
  const auto a = once.points(), b = twice.points(), c = often.points();
  INFO(a.size() << " " << b.size() << " " << c.size());
  REQUIRE(c.size() > 500);
  CHECK((a.size() > b.size() && b.size() > c.size()));
  int sightings_of_all = 0;  // points seen by several rigs are merged
  for (const auto& point : a) sightings_of_all += point.views;
  CHECK(2 * a.size() < static_cast<std::size_t>(sightings_of_all));
  for (const auto& point : c) {
    CHECK((point.views >= 5 && point.views <= 6));
    CHECK(std::abs(point.tangent.norm() - 1) < 1e-5F);
    CHECK((point.grey >= 0 && point.grey <= 255));
    CHECK((point.sigma > 0 && point.sigma < 0.5F));
  }
  const auto errors = depth_errors(c), all = depth_errors(a);
  const auto at = [](const std::vector<double>& sorted, double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  INFO(at(errors, 0.5) << " " << at(errors, 0.95) << " of all " << at(all, 0.5) << " " << at(all, 0.95));
  CHECK(at(errors, 0.5) < 0.005);
  CHECK(at(errors, 0.95) < at(all, 0.95));
}

TEST_CASE("points: the same frames give the same bytes, and memory is bounded", "[device]") {
  const TemporaryFolder folder;
  PointCloud first(tracked_room().config, seen_by(2)), second(tracked_room().config, seen_by(2)),
      small(tracked_room().config, seen_by(2, 1000));
  tracked_room().track_into({&first, &small});
  tracked_room().track_into({&second});
  write_ply(folder / "first.ply", first.points());
  write_ply(folder / "second.ply", second.points());
  CHECK(read_text(folder / "first.ply") == read_text(folder / "second.ply"));
  CHECK(first.dropped() == 0);
  CHECK(small.points().size() <= 1000);
  CHECK(small.points().size() > 100);
}

TEST_CASE("points: corrected poses move the views with their points, other views stay", "[device]") {
  PointCloud map(tracked_room().config, seen_by(1));
  tracked_room().track_into({&map});
  const auto before = map.points();
  const auto views = map.views();
  Eigen::Isometry3d moved(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()));
  moved.translation() = Eigen::Vector3d(4, 5, 6);
  const auto pose_of = [&](int frame) {
    for (const CloudView& view : views)
      if (view.frame == frame) return view.world_from_left;
    return Eigen::Isometry3d::Identity();
  };
  map.correct([&](int) { return std::nullopt; });
  REQUIRE(map.points().size() == before.size());
  CHECK(map.points().front().position == before.front().position);
  map.correct([&](int frame) { return moved * pose_of(frame); });
  const auto after = map.points();
  REQUIRE(after.size() == before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    CHECK((after[i].position - moved * before[i].position).norm() < 1e-9);
    CHECK((after[i].tangent.cast<double>() - moved.linear() * before[i].tangent.cast<double>()).norm() < 1e-5);
    // Information is kept in single precision: rotating it adds 1e-7 of the largest direction's, about 1e6 / m^2 or
    // more, to that of the smallest, which is 1 / sigma^2.
    const double information = 1 / std::pow(before[i].sigma, 2);
    CHECK(1 / std::pow(after[i].sigma, 2) == Approx(information).epsilon(1e-3).margin(0.1));
  }
  for (std::size_t i = 0; i < views.size(); ++i)
    CHECK((map.views()[i].world_from_left.matrix() - (moved * views[i].world_from_left).matrix()).norm() < 1e-12);
  // Only the last view moves: so do the points that it observed last, and no others.
  PointCloud other(tracked_room().config, seen_by(1));
  tracked_room().track_into({&other});
  other.correct([&](int frame) -> std::optional<Eigen::Isometry3d> {
    if (frame != views.back().frame) return std::nullopt;
    return moved * pose_of(frame);
  });
  const auto some = other.points();
  std::size_t same = 0, with_view = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    same += some[i].position == before[i].position ? 1 : 0;
    with_view += (some[i].position - moved * before[i].position).norm() < 1e-9 ? 1 : 0;
  }
  CHECK(same > 0);
  CHECK(with_view > 0);
  CHECK(same + with_view == some.size());
}

TEST_CASE("points: a file is either complete or absent, also without points") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_ply(folder / "absent/map.ply", {CloudPoint()}), DataError);
  write_ply(folder / "empty.ply", {});
  CHECK_THAT(read_text(folder / "empty.ply"), Contains("element vertex 0\n"));
}
