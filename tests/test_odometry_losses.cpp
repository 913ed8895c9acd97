#include "tracked_room.hpp"

using namespace quadedge;
using namespace matching;
using namespace tracked_room;

TEST_CASE("odometry: a black frame is lost, and tracking resumes at the right pose", "[device]") {
  Tracker odometry;
  const Image black(240, 150);
  for (std::size_t i = 0; i < 6; ++i) {
    INFO("frame " << i);
    if (i == 3) {
      const auto before = odometry.track({150000000, black.view(), black.view()});
      CHECK(before.status == FrameStatus::lost_too_few_edges);
      CHECK_FALSE(before.message.empty());
      CHECK(before.counts.stereo_edges == 0);
      // The last motion repeated: the path is smooth, so the guess is near.
      CHECK_FALSE(before.world_from_left);
      CHECK_FALSE(before.current_from_reference);
      CHECK_FALSE(before.covariance);
      CHECK(before.segment == 0);
      CHECK_FALSE(before.relative_covariance);
      check_pose(before.predicted_world_from_left, room().world_from_left[i], 0.03, 1);
      CHECK(odometry.details().stereo.size() == 0);
      continue;
    }
    const auto result = odometry.track(room().frame(i));
    CHECK(is_tracked(result.status));
    CHECK_FALSE(result.predicted_world_from_left);
    CHECK(result.segment == 0);  // located against the frame before the loss
    check_pose(result.world_from_left, room().world_from_left[i], 4e-3, 0.1);
  }
}

TEST_CASE("odometry: a dropped frame does not halve the velocity", "[device]") {
  const Image black(240, 150);
  const auto dark = [&](std::size_t i) { return at(room().frame(i).stamp_ns, {0, black.view(), black.view()}); };
  {  // frame 4 is dropped before the dark frame 5: two intervals since frame 3
    Tracker odometry;
    for (std::size_t i : {0, 1, 2, 3}) REQUIRE(is_tracked(odometry.track(room().frame(i)).status));
    check_pose(odometry.track(dark(5)).predicted_world_from_left, room().world_from_left[5], 0.01, 0.3);
  }
  {  // frame 3 is dropped: the last motion was that of two intervals
    Tracker odometry;
    for (std::size_t i : {0, 1, 2, 4}) REQUIRE(is_tracked(odometry.track(room().frame(i)).status));
    check_pose(odometry.track(dark(5)).predicted_world_from_left, room().world_from_left[5], 0.01, 0.3);
  }
}

TEST_CASE("odometry: in the dark the last motion is repeated once, not for ever", "[device]") {
  Tracker odometry;
  const Image black(240, 150);
  for (std::size_t i : {0, 1, 2}) REQUIRE(is_tracked(odometry.track(room().frame(i)).status));
  std::vector<Eigen::Isometry3d> predicted;
  for (std::int64_t i = 3; i < 8; ++i)
    predicted.push_back(*odometry.track({i * 50000000, black.view(), black.view()}).predicted_world_from_left);
  CHECK((predicted[0].translation() - room().world_from_left[2].translation()).norm() > 1e-3);
  for (const auto& pose : predicted) CHECK(pose.isApprox(predicted[0], 1e-9));
}

TEST_CASE("odometry: a frame from another place is lost, and the next one is tracked at the right pose", "[device]") {
  const RenderedScene elsewhere("cables", 240, 150, 1);
  Config config = room().config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, elsewhere.config.stereo.max_disparity);
  Tracker odometry(room().rig, config);
  for (std::size_t i : {0, 1, 2}) CHECK(is_tracked(odometry.track(room().frame(i)).status));
  const auto lost = odometry.track(at(room().frame(3).stamp_ns, elsewhere.frame(0)));
  CHECK_FALSE(is_tracked(lost.status));
  CHECK(lost.counts.stereo_edges > 100);
  const auto result = odometry.track(room().frame(4));
  CHECK(result.status == FrameStatus::tracked);
  CHECK(lost.diagnostics.base_frame == -1);
  CHECK(result.reference_frame == 2);  // the last frame that had a pose
  CHECK(result.diagnostics.base_frame == 2);
  CHECK(result.segment == 0);
  CHECK(result.warnings.empty());
  check_pose(result.world_from_left, room().world_from_left[4], 4e-3, 0.1);
}

TEST_CASE("odometry: in another place a new segment starts from the lost frame", "[device]") {
  const RenderedScene before("cables", 240, 150, 1);
  Config config = room().config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, before.config.stereo.max_disparity);
  Tracker odometry(room().rig, config);
  CHECK(odometry.track(before.frame(0)).status == FrameStatus::first);
  const auto lost = odometry.track(room().frame(0));
  CHECK_FALSE(is_tracked(lost.status));
  const auto relocalised = odometry.track(room().frame(1));
  CHECK(relocalised.status == FrameStatus::tracked);
  CHECK(relocalised.reference_frame == 1);
  CHECK(relocalised.diagnostics.base_frame == 1);
  CHECK(relocalised.new_key_rig);  // the lost frame's own pose is a prediction
  CHECK(lost.segment == 0);
  CHECK_THAT(relocalised.message, Catch::Matchers::Contains("segment 1 starts: relocalised against frame 1"));
  REQUIRE(relocalised.warnings.size() == 1);
  CHECK(relocalised.warnings[0].kind == WarningKind::unknown_motion);
  CHECK_THAT(relocalised.warnings[0].text, Catch::Matchers::Contains("between frames 0 and 2 is unknown"));
  const auto after = odometry.track(room().frame(2));
  CHECK(after.status == FrameStatus::tracked);
  CHECK(after.message.empty());
  for (const auto* result : {&relocalised, &after}) {
    CHECK(result->segment == 1);
    // The lost frame's predicted pose counts as exact, so that the first pose measured against it is as uncertain as
    // the motion, seen along other axes.
    REQUIRE((result->covariance && result->diagnostics.covariance_in_reference));
    const auto position = [](const PoseCovariance& covariance) { return covariance.topLeftCorner<3, 3>().trace(); };
    CHECK(position(*result->covariance) > 0);
    if (result == &relocalised)
      CHECK(position(*result->covariance) == Approx(position(*result->diagnostics.covariance_in_reference)));
    const auto& truth = room().world_from_left[result == &after ? 2 : 1];
    const Eigen::Isometry3d motion = lost.predicted_world_from_left.value().inverse() * result->world_from_left.value();
    CHECK((motion.translation() - truth.translation()).norm() < 4e-3);
    CHECK(turn_between(motion, truth) < 0.1 * kDegree);
  }
}

TEST_CASE("odometry: the search beside the rig check leaves no trace of a frame that does not fit the rig",
          "[device]") {
  // The right camera freezes in frame 4. A frame without edges is not searched at all; what follows is the same.
  const auto last_frames = [](const StereoFrame& fourth) {
    Tracker odometry;
    std::vector<FrameResult> results;
    for (std::size_t i = 0; i < room().left.size(); ++i) {
      const FrameResult result = odometry.track(at(static_cast<std::int64_t>(i), i == 4 ? fourth : room().frame(i)));
      if (i >= 4) results.push_back(result);
    }
    return results;
  };
  const Image grey(room().rig.left.width, room().rig.left.height);
  const auto frozen = last_frames({0, room().left[4].view(), room().right[3].view()}),
             empty = last_frames({0, grey.view(), grey.view()});
  CHECK(frozen[0].status == FrameStatus::lost_rig_mismatch);
  CHECK(frozen[0].counts.quads == 0);
  CHECK(empty[0].status == FrameStatus::lost_too_few_edges);
  for (std::size_t i = 1; i < frozen.size(); ++i) {
    CHECK(frozen[i].status == FrameStatus::tracked);
    CHECK(same_bytes(frozen[i], empty[i]));
  }
}

TEST_CASE("odometry: a turn by a third of the view, and one about the optical axis, are found", "[device]") {
  const auto world = synthetic::make_room(7, room().rig.left.fx);
  const auto render = [&](const Eigen::Isometry3d& camera_from_world) {
    return render_view(world, room().rig.left, camera_from_world);
  };
  Eigen::Isometry3d yawed = Eigen::Isometry3d::Identity(), rolled = yawed;
  yawed.linear() = Eigen::AngleAxisd(25 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  yawed.translation() = Eigen::Vector3d(0.1, -0.05, 0.15);
  rolled.linear() = Eigen::AngleAxisd(40 * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const Eigen::Isometry3d& world_from_left : {yawed, rolled}) {
    Tracker odometry;
    FrameResult result;
    for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d(Eigen::Isometry3d::Identity()), world_from_left}) {
      const Image left = render(pose.inverse()), right = render(room().rig.right_from_left * pose.inverse());
      result = odometry.track({0, left.view(), right.view()});
    }
    CHECK(result.status == FrameStatus::tracked);
    check_pose(result.world_from_left, world_from_left, 0.01, 0.3);
  }
}

TEST_CASE("odometry: a sequence with dark first frames starts at the first frame with edges", "[device]") {
  Tracker odometry;
  const Image black(240, 150);
  CHECK(odometry.track({0, black.view(), black.view()}).status == FrameStatus::lost_too_few_edges);
  CHECK(odometry.track(room().frame(0)).status == FrameStatus::first);
  const auto result = odometry.track(room().frame(1));
  CHECK(result.status == FrameStatus::tracked);
  CHECK(result.reference_frame == 1);
  check_pose(result.world_from_left, room().world_from_left[1], 4e-3, 0.1);
}

TEST_CASE("odometry: after a restart, stamps may go back and a segment starts", "[device]") {
  Tracker odometry;
  odometry.restart();  // before the first frame it means nothing
  for (std::size_t i = 0; i < 3; ++i) odometry.track(at(1000 + static_cast<std::int64_t>(i), room().frame(i)));
  odometry.restart();
  const FrameResult first = odometry.track(at(5, room().frame(5)));
  CHECK(first.status == FrameStatus::first);
  CHECK(first.segment == 1);
  CHECK(first.new_key_rig);
  CHECK_THAT(first.message, Catch::Matchers::Contains("segment 1 starts"));
  const FrameResult second = odometry.track(at(6, room().frame(6)));
  CHECK(second.status == FrameStatus::tracked);
  CHECK(second.segment == 1);
  // The motion within the segment is measured; the segment begins where the last one ended.
  const auto step = [](const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) { return from.inverse() * to; };
  check_pose(step(*first.world_from_left, *second.world_from_left),
             step(room().world_from_left[5], room().world_from_left[6]), 6e-3, 0.15);
  CHECK((first.world_from_left->translation() - room().world_from_left[2].translation()).norm() < 6e-3);
  CHECK_THROWS_AS(odometry.track(at(4, room().frame(7))), DataError);
}
