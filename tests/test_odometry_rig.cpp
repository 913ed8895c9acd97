#include "geometry/undistortion.hpp"
#include "scenes/path.hpp"
#include "tracked_room.hpp"

using namespace quadedge;
using namespace matching;
using namespace tracked_room;

TEST_CASE("odometry: rows that lie beside those of the calibration cost no accuracy, but are warned of", "[device]") {
  const RenderedScene off = room_with_rows_off_by(0.8);
  for (const auto& name : all_devices_and_reference()) {
    INFO(name);
    const auto right = track(room(), name, room().config), found = track(off, name, off.config);
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(right[i].diagnostics.rig_evidence.epipolar_correction == 0);
      CHECK(found[i].diagnostics.rig_evidence.epipolar_correction == Approx(0.8).margin(0.05));
      CHECK(found[i].counts.stereo_edges > 0.95 * right[i].counts.stereo_edges);
      CHECK(found[i].counts.inliers >= 0.9 * right[i].counts.inliers);
      check_pose(found[i].world_from_left, room().world_from_left[i], 2e-3, 0.1);
    }
    REQUIRE(found[0].warnings.size() == 1);
    CHECK(found[0].warnings[0].kind == WarningKind::doubtful_calibration);
  }
}

TEST_CASE("odometry: lost frames leave no trace in the rectification error", "[device]") {
  // Before the first frame with a pose, and after it.
  const RenderedScene off = room_with_rows_off_by(0.8);
  const Image grey(off.rig.left.width, off.rig.left.height);
  for (const std::size_t lost : {std::size_t{0}, std::size_t{4}}) {
    const auto last_frames = [&](const StereoFrame& mismatch) {
      Tracker odometry(off.rig, off.config);
      std::vector<FrameResult> results;
      for (std::size_t i = 0; i < off.left.size(); ++i)
        results.push_back(odometry.track(at(static_cast<std::int64_t>(i), i == lost ? mismatch : off.frame(i))));
      return results;
    };
    const auto exchanged = last_frames({0, off.right[lost].view(), off.left[lost].view()}),
               empty = last_frames({0, grey.view(), grey.view()});
    CHECK(exchanged[lost].status == FrameStatus::lost_rig_mismatch);
    CHECK(empty[lost].status == FrameStatus::lost_too_few_edges);
    for (std::size_t i = lost + 1; i < exchanged.size(); ++i) CHECK(same_bytes(exchanged[i], empty[i]));
  }
}

TEST_CASE("odometry: a pair of images that repeats is tracked with a message in each frame and one warning",
          "[device]") {
  Tracker odometry;
  const auto repeats = [](const FrameResult& result) {
    return result.message.find("identical to those of the previous frame") != std::string::npos;
  };
  odometry.track(at(0, room().frame(0)));
  const FrameResult before = odometry.track(at(1, room().frame(1)));
  CHECK_FALSE(repeats(before));
  for (const std::int64_t stamp : {2, 3}) {
    const FrameResult result = odometry.track(at(stamp, room().frame(1)));
    CHECK(result.status == FrameStatus::tracked);
    check_pose(result.world_from_left, *before.world_from_left, 1e-4, 1e-3);  // it has not moved
    CHECK(repeats(result));
    CHECK(result.warnings.size() == (stamp == 2 ? 1 : 0));
  }
  CHECK_FALSE(repeats(odometry.track(at(4, room().frame(2)))));
}

TEST_CASE("odometry: a wrong principal point of the right camera is warned of", "[device]") {
  StereoRig rig = room().rig;
  rig.right.cx -= 4;
  Tracker odometry(rig);
  std::set<WarningKind> kinds;
  double largest = 0;
  for (std::size_t i = 0; i < room().left.size(); ++i) {
    const FrameResult result = odometry.track(room().frame(i));
    largest = std::max(largest, std::abs(result.rig.disparity_offset));
    for (const Warning& warning : result.warnings) kinds.insert(warning.kind);
  }
  INFO("largest offset " << largest << " px");
  CHECK(kinds.count(WarningKind::large_disparity_offset) == 1);
}

TEST_CASE("odometry: a right camera that turns during the recording is noticed once, and followed", "[device]") {
  RenderedScene turning = room(), sound = room();  // both run to and fro
  for (auto* scene : {&turning, &sound}) {
    for (std::size_t i = 0; i < 14; ++i) {
      const std::size_t from = i < 7 ? 6 - i : i - 6;
      scene->left.push_back(room().left[from]);
      scene->right.push_back(room().right[from]);
      scene->world_from_left.push_back(room().world_from_left[from]);
    }
  }
  const double sine = std::sin(0.6 * kDegree), cosine = std::cos(0.6 * kDegree);
  const std::size_t turned = 10;
  for (std::size_t i = turned; i < turning.right.size(); ++i) {
    const Image from = turning.right[i];
    for (int y = 0; y < from.height; ++y) {
      for (int x = 0; x < from.width; ++x) {
        const double u = x - turning.rig.right.cx, v = y - turning.rig.right.cy;
        const float grey =
            bilinear(from.width, from.height, turning.rig.right.cx + cosine * u - sine * v,
                     turning.rig.right.cy + sine * u + cosine * v, [&](int column, int row) {
                       return static_cast<float>(from.pixels[static_cast<std::size_t>(row * from.width + column)]);
                     });
        turning.right[i].set(x, y, static_cast<std::uint8_t>(std::lround(grey)));
      }
    }
  }
  const auto warned = [&](const RenderedScene& scene) {
    std::vector<std::size_t> frames;
    const auto results = track(scene, all_devices().front(), scene.config);
    for (std::size_t i = 0; i < results.size(); ++i) {
      CHECK(is_tracked(results[i].status));
      for (const Warning& warning : results[i].warnings) {
        CHECK(warning.kind != WarningKind::unsynchronised_cameras);
        if (warning.kind == WarningKind::changed_rig) frames.push_back(i);
      }
    }
    return frames;
  };
  CHECK(warned(sound).empty());
  CHECK(warned(turning) == std::vector<std::size_t>{turned + 3});
}

TEST_CASE("odometry: right images that are displaced from frame to frame are followed, with one warning", "[device]") {
  RenderedScene displaced = room();
  const int by[] = {0, 0, 0, 3, -2, 1, 0, -3};
  for (std::size_t i = 0; i < displaced.right.size(); ++i) {
    const Image from = displaced.right[i];
    Image& to = displaced.right[i];
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x)
        to.set(x, y, from.pixels[static_cast<std::size_t>(y * from.width + std::clamp(x + by[i], 0, from.width - 1))]);
  }
  const auto results = track(displaced, all_devices().front(), displaced.config),
             sound = track(room(), all_devices().front(), room().config);
  int warned = 0;
  for (std::size_t i = 1; i < results.size(); ++i) {
    CAPTURE(i);
    check_pose(results[i].world_from_left, room().world_from_left[0].inverse() * room().world_from_left[i], 0.02, 0.3);
    CHECK((results[i].message.find("displaced") != std::string::npos) == (by[i] != 0));
    for (const Warning& warning : results[i].warnings) warned += warning.kind == WarningKind::displaced_images ? 1 : 0;
    CHECK(sound[i].warnings.empty());
  }
  CHECK(warned == 1);
}

TEST_CASE("odometry: images that do not fit the calibration are lost with a reason, and each warning is given once",
          "[device]") {
  const RenderedScene scene("room", 320, 200, 3);
  Tracker exchanged(scene.rig, scene.config);
  for (std::size_t i = 0; i < 3; ++i) {
    const StereoFrame frame{static_cast<std::int64_t>(i) - 3, scene.right[i].view(), scene.left[i].view()};
    const FrameResult result = exchanged.track(frame);
    CHECK(result.status == FrameStatus::lost_rig_mismatch);
    CHECK(result.message.find("are left and right exchanged") != std::string::npos);
    CHECK(result.diagnostics.rig_evidence.negative_ratio > 0.9);
  }
  const FrameResult first = exchanged.track(scene.frame(0));  // tracking starts at the first frame that fits
  CHECK(first.status == FrameStatus::first);
  CHECK(exchanged.track(scene.frame(1)).status == FrameStatus::tracked);

  StereoRig pitched = scene.rig;
  pitched.right_from_left.linear() = Eigen::AngleAxisd(0.5 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Tracker doubtful(pitched, scene.config);
  for (std::size_t i = 0; i < 3; ++i) {
    const FrameResult result = doubtful.track(scene.frame(i));
    CHECK(is_tracked(result.status));
    REQUIRE(result.warnings.size() == (i == 0 ? 1U : 0U));
    if (i > 0) continue;
    CHECK(result.warnings[0].kind == WarningKind::doubtful_calibration);
    CHECK(result.warnings[0].text.find("doubtful") != std::string::npos);
  }
}

TEST_CASE("odometry: all warnings of one kind come with the first frame that has any", "[device]") {
  // Only the left part of both images, so that both principal points lie outside.
  StereoRig cropped = room().rig;
  cropped.left.width = cropped.right.width = 110;
  REQUIRE(cropped.left.cx > 110);
  Tracker odometry(cropped);
  for (std::size_t i = 0; i < 3; ++i) {
    StereoFrame frame = room().frame(i);
    frame.left.width = frame.right.width = 110;
    const FrameResult result = odometry.track(frame);
    CHECK(is_tracked(result.status));
    REQUIRE(result.warnings.size() == (i == 0 ? 2U : 0U));
    for (const Warning& warning : result.warnings) CHECK(warning.kind == WarningKind::implausible_calibration);
  }
}

TEST_CASE("odometry: a rig alone is enough, and its disparity range is used", "[device]") {
  StereoOdometry odometry(room().rig);
  CHECK(odometry.device().name == Device("auto").info().name);
  CHECK(odometry.track(room().frame(0)).diagnostics.disparity_range == Approx(room().rig.max_disparity));

  StereoRig unknown = room().rig;
  unknown.max_disparity = 0;  // then that of a point 0.5 m away
  CHECK(StereoOdometry(unknown).track(room().frame(0)).diagnostics.disparity_range ==
        Approx(unknown.left.fx * unknown.baseline() / 0.5));
  Config nearest;
  nearest.stereo.min_depth = 2;
  CHECK(StereoOdometry(room().rig, nearest).track(room().frame(0)).diagnostics.disparity_range ==
        Approx(unknown.left.fx * unknown.baseline() / 2));
}

TEST_CASE("odometry: the disparity range follows the images", "[device]") {
  const auto expected = track(room(), "auto", room().config);
  StereoRig narrow = room().rig;
  narrow.max_disparity /= 4;
  StereoOdometry odometry(narrow);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const FrameResult result = odometry.track(room().frame(i));
    INFO("frame " << i << ", range " << result.diagnostics.disparity_range);
    CHECK(result.warnings.empty());
    CHECK(result.counts.stereo_edges > 0.97 * expected[i].counts.stereo_edges);
  }
  Config limited;  // a range in the configuration is kept
  limited.stereo.max_disparity = narrow.max_disparity;
  StereoOdometry fixed(room().rig, limited);
  const FrameResult result = fixed.track(room().frame(0));
  CHECK(result.diagnostics.disparity_range == Approx(limited.stereo.max_disparity));
  CHECK(result.counts.stereo_edges < 0.8 * expected[0].counts.stereo_edges);
}

TEST_CASE("odometry: cameras of different sizes and orientations track too", "[device]") {
  RenderedScene scene = RenderedScene("cables", 64, 48, 1);  // replaced below
  scene.rig.left = {185, 187, 158, 101, 320, 200};
  scene.rig.right = {170, 168, 150, 128, 300, 240};
  scene.rig.right_from_left.linear() =
      Eigen::AngleAxisd(0.06, Eigen::Vector3d(0.5, 1, -0.8).normalized()).toRotationMatrix();
  scene.rig.right_from_left.translation() = Eigen::Vector3d(-0.14, 0.05, 0.01);
  const auto world = synthetic::make_room(7, 185);
  scene.left.clear();
  scene.right.clear();
  scene.world_from_left.clear();
  const synthetic::CameraPath path("ellipse", 7, 4, world.lane);
  for (int i = 0; i < 4; ++i) {
    scene.world_from_left.push_back(path.world_from_left(i));
    const Eigen::Isometry3d left_from_scene = path.scene_from_left(i).inverse();
    scene.left.push_back(render_view(world, scene.rig.left, left_from_scene));
    scene.right.push_back(render_view(world, scene.rig.right, scene.rig.right_from_left * left_from_scene));
  }
  scene.config = {};
  scene.config.stereo.min_depth = 0.8 * world.nearest;
  for (const auto& name : all_devices()) {
    const auto results = track(scene, name, scene.config);
    for (std::size_t i = 1; i < results.size(); ++i) {
      CHECK(results[i].status == FrameStatus::tracked);
      check_pose(results[i].world_from_left, scene.world_from_left[i], 4e-3, 0.1);
    }
  }
}
