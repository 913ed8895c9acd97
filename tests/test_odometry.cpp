#include <tbb/global_control.h>

#include "geometry/uncertain_pose.hpp"
#include "tracked_room.hpp"

using namespace quadedge;
using namespace matching;
using namespace tracked_room;

TEST_CASE("odometry: a rendered room is tracked reproducibly", "[device]") {
  for (const auto& name : all_devices()) {
    const auto results = track(room(), name, room().config), again = track(room(), name, room().config);
    CHECK(results[0].status == FrameStatus::first);
    CHECK(results[0].world_from_left->matrix() == Eigen::Matrix4d::Identity());
    CHECK(results[0].new_key_rig);
    for (std::size_t i = 0; i < results.size(); ++i) {
      INFO("device " << name << ", frame " << i);
      CHECK(same_bytes(results[i], again[i]));
      if (i == 0) continue;
      const FrameResult& result = results[i];
      CHECK(result.status == FrameStatus::tracked);
      check_pose(result.world_from_left, room().world_from_left[i], 4e-3, 0.1);
      CHECK_FALSE(result.diagnostics.overflow);
      CHECK(result.counts.inliers > 500);
      CHECK(result.counts.inliers <= result.counts.quads);
      // The reference is the keyframe: the pose is its pose and the motion from it.
      const auto& reference = results[static_cast<std::size_t>(result.reference_frame)];
      CHECK(reference.new_key_rig);
      CHECK(result.diagnostics.base_frame >= result.reference_frame);
      CHECK((*reference.world_from_left * result.current_from_reference.value().inverse())
                .isApprox(*result.world_from_left, 1e-9));
      const Eigen::Matrix<double, 6, 6>& relative = result.relative_covariance.value();
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(relative);
      CHECK((relative - relative.transpose()).norm() < 1e-9 * relative.norm());
      CHECK(solver.eigenvalues().minCoeff() > 0);
      CHECK(std::sqrt(relative.topLeftCorner<3, 3>().trace()) < 0.02);
      // In the world a pose is no more certain than its keyframe is.
      REQUIRE((result.covariance && reference.covariance && result.diagnostics.covariance_in_reference));
      CHECK((*result.covariance - *reference.covariance).topLeftCorner<3, 3>().trace() > 0);
      // The edges' own uncertainty is only turned; the rig's comes on top.
      const auto by_rig = pose::rig_covariance(result.diagnostics.rig_sensitivity, room().config.pose);
      CHECK((*result.diagnostics.covariance_in_reference - by_rig).topLeftCorner<3, 3>().trace() ==
            Approx(relative.topLeftCorner<3, 3>().trace()));
      CHECK(by_rig.trace() > 0);
    }
  }
}

TEST_CASE("odometry: the C++ reference tracks too and agrees with the devices", "[device]") {
  const RenderedScene scene("room", 200, 125, 3);
  const auto truth = track(scene, "reference", scene.config);
  for (std::size_t i = 1; i < truth.size(); ++i)
    check_pose(truth[i].world_from_left, scene.world_from_left[i], 6e-3, 0.15);
  for (const auto& name : all_devices()) {
    const auto results = track(scene, name, scene.config);
    for (std::size_t i = 1; i < truth.size(); ++i) {
      CHECK(results[i].status == truth[i].status);
      check_pose(results[i].world_from_left, *truth[i].world_from_left, 2e-4, 0.005);
    }
  }
}

TEST_CASE("odometry: one processor gives the same bytes as several", "[device]") {
  const RenderedScene off = room_with_rows_off_by(0.8);
  auto several = track(room(), all_devices().front(), room().config);
  for (const auto& result : track(off, all_devices().front(), off.config)) several.push_back(result);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  auto alone = track(room(), all_devices().front(), room().config);
  for (const auto& result : track(off, all_devices().front(), off.config)) alone.push_back(result);
  for (std::size_t i = 0; i < several.size(); ++i) {
    CHECK(same_bytes(several[i], alone[i]));
    CHECK(several[i].diagnostics.rig_evidence.matched_ratio == alone[i].diagnostics.rig_evidence.matched_ratio);
    CHECK(several[i].diagnostics.rig_evidence.epipolar_residual == alone[i].diagnostics.rig_evidence.epipolar_residual);
  }
}

TEST_CASE("odometry: before the first frame there are no details", "[device]") {
  for (const auto& name : all_devices_and_reference()) {
    const Tracker odometry(room().rig, room().config, name);
    const FrameDetails details = odometry.details();
    CHECK(details.left_edges.size() == 0);
    CHECK(details.stereo.size() == 0);
    CHECK(details.previous_stereo.size() == 0);
    CHECK(details.quads.size() == 0);
  }
}

TEST_CASE("odometry: timestamps that go back and images of another size are refused without effect", "[device]") {
  const Image small(239, 150);
  Tracker odometry;
  CHECK(odometry.track(at(1000, room().frame(0))).status == FrameStatus::first);
  CHECK_THROWS_AS(odometry.track(at(999, room().frame(1))), DataError);
  CHECK_THROWS_WITH(odometry.track(at(-5, room().frame(1))),
                    Catch::Matchers::Contains("-5") && Catch::Matchers::Contains("expected at least 1000"));
  CHECK_THROWS_AS(odometry.track({1001, small.view(), room().right[0].view()}), DataError);
  CHECK_THROWS_AS(odometry.track({1001, {}, {}}), DataError);
  // The timestamps of refused frames do not count, and a repeated timestamp is allowed.
  const auto result = odometry.track(at(1000, room().frame(1)));
  CHECK(result.status == FrameStatus::tracked);
  CHECK(result.reference_frame == 0);
}

TEST_CASE("odometry: once the scene has been seen, frames allocate nothing on the device", "[device]") {
  for (const auto& name : all_devices()) {
    Tracker odometry(room().rig, room().config, name);
    const std::size_t last = room().left.size() - 1;
    std::int64_t stamp = 0;
    const auto track_there_and_back = [&] {
      for (std::size_t i = 0; i < last; ++i)
        CHECK(odometry.track(at(++stamp, room().frame(i))).status != FrameStatus::lost_no_consensus);
      for (std::size_t i = last; i > 0; --i)
        CHECK(odometry.track(at(++stamp, room().frame(i))).status == FrameStatus::tracked);
    };
    for (int pass = 0; pass < 3; ++pass) track_there_and_back();  // rigs alternate in holding the frames
    const std::size_t bytes = odometry.device_bytes();
    CHECK(bytes > 0);
    track_there_and_back();
    CHECK(odometry.device_bytes() == bytes);
  }
}

TEST_CASE("odometry: without keyframes every frame is tracked against the previous one", "[device]") {
  Config config = room().config;
  config.odometry.key_rig = false;
  const auto results = track(room(), all_devices().front(), config);
  for (std::size_t i = 1; i < results.size(); ++i) {
    CHECK(results[i].status == FrameStatus::tracked);
    CHECK(results[i].reference_frame == static_cast<int>(i) - 1);
    CHECK(results[i].diagnostics.base_frame == static_cast<int>(i) - 1);
    check_pose(results[i].world_from_left, room().world_from_left[i], 6e-3, 0.15);
  }
}

TEST_CASE("odometry: a keyframe is replaced after the maximum number of frames", "[device]") {
  Config config = room().config;
  config.odometry.key_max_frames = 3;
  config.odometry.key_min_quads = 0;
  config.odometry.key_min_quad_ratio = 0;
  const auto results = track(room(), all_devices().front(), config);
  const std::vector<int> expected = {0, 0, 0, 0, 3, 3, 3, 6};
  for (std::size_t i = 0; i < results.size(); ++i) {
    CHECK(results[i].reference_frame == expected[i]);
    CHECK(results[i].new_key_rig == (i % 3 == 0));
  }
}

TEST_CASE("odometry: edges beyond the capacity are reported", "[device]") {
  Config config = room().config;
  config.edges.max_edges = 3000;
  for (const auto& name : {std::string("reference"), all_devices().front()}) {
    Tracker odometry(room().rig, config, name);
    const auto result = odometry.track(room().frame(0));
    CHECK(result.diagnostics.overflow);
    CHECK(result.message.find("max_edges") != std::string::npos);
    CHECK(result.counts.edges_left == 3000);
    CHECK(result.status == FrameStatus::first);
    const auto edges = odometry.details().left_edges;
    CHECK(edges.size() == 3000);
    CHECK(edges.row_first.back() == 3000);
  }
}

TEST_CASE("odometry: restart() waits for another user of the device", "[device]") {
  Tracker odometry;
  std::atomic<bool> is_done{false};
  std::thread other;
  {
    const auto use = odometry.own.use();
    other = std::thread([&] {
      odometry.restart();
      is_done = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK_FALSE(is_done);
  }
  other.join();
  CHECK(is_done);
}
