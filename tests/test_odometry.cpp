#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>
#include <tbb/global_control.h>

#include "frontends.hpp"
#include "geometry/uncertain_pose.hpp"
#include "geometry/undistortion.hpp"
#include "quadedge/error.hpp"
#include "quadedge/match_stereo.hpp"
#include "quadedge/odometry.hpp"
#include "scenes/path.hpp"
#include "scenes/render.hpp"
#include "scenes/scenes.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Eight frames of the room, rendered once.
const RenderedScene& room() {
  static const RenderedScene scene("room", 240, 150, 8);
  return scene;
}

std::vector<FrameResult> track(const RenderedScene& scene, const std::string& device_name, const Config& config) {
  Device device(device_name, kept_programs());
  StereoOdometry odometry(scene.rig, device, config);
  std::vector<FrameResult> results;
  for (std::size_t i = 0; i < scene.left.size(); ++i) results.push_back(odometry.track(scene.frame(i)));
  return results;
}

double turn_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd((a.inverse() * b).linear()).angle();
}

/// The room, whose right images lie lower than the calibration says.
RenderedScene room_with_rows_off_by(double pixels) {
  RenderedScene scene = room();
  scene.rig.right.cy -= pixels;
  return scene;
}

/// The first frame is the origin in both. Metres and degrees.
void check_pose(const std::optional<Eigen::Isometry3d>& world_from_left, const Eigen::Isometry3d& truth, double metres,
                double degrees) {
  INFO("moved " << truth.translation().norm() << " m");
  REQUIRE(world_from_left);
  CHECK((world_from_left->translation() - truth.translation()).norm() < metres);
  CHECK(turn_between(*world_from_left, truth) < degrees * kDegree);
}

/// The frame at another time, for sequences in another order.
StereoFrame at(std::int64_t stamp_ns, StereoFrame frame) {
  frame.stamp_ns = stamp_ns;
  return frame;
}

bool same_bytes(const std::optional<Eigen::Isometry3d>& a, const std::optional<Eigen::Isometry3d>& b) {
  return a.has_value() == b.has_value() && (!a || a->matrix() == b->matrix());
}

/// All but times.
bool same_bytes(const FrameResult& a, const FrameResult& b) {
  return a.status == b.status && same_bytes(a.world_from_left, b.world_from_left) &&
         same_bytes(a.predicted_world_from_left, b.predicted_world_from_left) &&
         same_bytes(a.current_from_reference, b.current_from_reference) && a.covariance == b.covariance &&
         a.relative_covariance == b.relative_covariance && a.reference_frame == b.reference_frame &&
         a.diagnostics.base_frame == b.diagnostics.base_frame && a.new_key_rig == b.new_key_rig &&
         a.diagnostics.overflow == b.diagnostics.overflow && a.message == b.message && a.segment == b.segment &&
         a.counts.quads == b.counts.quads && a.counts.inliers == b.counts.inliers;
}

}  // namespace

TEST_CASE("odometry: a rendered room is tracked reproducibly", "[odometry][device]") {
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

TEST_CASE("odometry: the C++ reference tracks too and agrees with the devices", "[odometry][device]") {
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

TEST_CASE("odometry: a repeated frame has not moved", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
  odometry.track(room().frame(0));
  for (int k = 0; k < 2; ++k) {
    const auto result = odometry.track(room().frame(0));
    CHECK(result.status == FrameStatus::tracked);
    check_pose(result.world_from_left, Eigen::Isometry3d::Identity(), 1e-4, 1e-3);
  }
}

TEST_CASE("odometry: a black frame is lost, and tracking resumes at the right pose", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
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

TEST_CASE("odometry: a dropped frame does not halve the velocity", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  const Image black(240, 150);
  const auto dark = [&](std::size_t i) { return at(room().frame(i).stamp_ns, {0, black.view(), black.view()}); };
  {  // frame 4 is dropped before the dark frame 5: two intervals since frame 3
    StereoOdometry odometry(room().rig, device, room().config);
    for (std::size_t i : {0, 1, 2, 3}) REQUIRE(is_tracked(odometry.track(room().frame(i)).status));
    check_pose(odometry.track(dark(5)).predicted_world_from_left, room().world_from_left[5], 0.01, 0.3);
  }
  {  // frame 3 is dropped: the last motion was that of two intervals
    StereoOdometry odometry(room().rig, device, room().config);
    for (std::size_t i : {0, 1, 2, 4}) REQUIRE(is_tracked(odometry.track(room().frame(i)).status));
    check_pose(odometry.track(dark(5)).predicted_world_from_left, room().world_from_left[5], 0.01, 0.3);
  }
}

TEST_CASE("odometry: in the dark the last motion is repeated once, not for ever", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
  const Image black(240, 150);
  for (std::size_t i : {0, 1, 2}) REQUIRE(is_tracked(odometry.track(room().frame(i)).status));
  std::vector<Eigen::Isometry3d> predicted;
  for (std::int64_t i = 3; i < 8; ++i)
    predicted.push_back(*odometry.track({i * 50000000, black.view(), black.view()}).predicted_world_from_left);
  CHECK((predicted[0].translation() - room().world_from_left[2].translation()).norm() > 1e-3);
  for (const auto& pose : predicted) CHECK(pose.isApprox(predicted[0], 1e-9));
}

TEST_CASE("odometry: a frame from another place is lost, and the next one is tracked at the right pose",
          "[odometry][device]") {
  const RenderedScene elsewhere("cables", 240, 150, 1);
  Config config = room().config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, elsewhere.config.stereo.max_disparity);
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, config);
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

TEST_CASE("odometry: in another place a new segment starts from the lost frame", "[odometry][device]") {
  const RenderedScene before("cables", 240, 150, 1);
  Config config = room().config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, before.config.stereo.max_disparity);
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, config);
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
          "[odometry][rig][device]") {
  // The right camera freezes in frame 4. A frame without edges is not searched at all; what follows is the same.
  const auto last_frames = [](const StereoFrame& fourth) {
    Device device(all_devices().front(), kept_programs());
    StereoOdometry odometry(room().rig, device, room().config);
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

TEST_CASE("odometry: rows that lie beside those of the calibration cost no accuracy, but are warned of",
          "[odometry][rig][device]") {
  const RenderedScene off = room_with_rows_off_by(0.8);
  auto names = all_devices();
  names.emplace_back("reference");
  for (const auto& name : names) {
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

TEST_CASE("odometry: lost frames leave no trace in the rectification error", "[odometry][rig][device]") {
  // Before the first frame with a pose, and after it.
  const RenderedScene off = room_with_rows_off_by(0.8);
  const Image grey(off.rig.left.width, off.rig.left.height);
  for (const std::size_t lost : {std::size_t{0}, std::size_t{4}}) {
    const auto last_frames = [&](const StereoFrame& mismatch) {
      Device device(all_devices().front(), kept_programs());
      StereoOdometry odometry(off.rig, device, off.config);
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
          "[odometry][rig][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
  const auto repeats = [](const FrameResult& result) {
    return result.message.find("identical to those of the previous frame") != std::string::npos;
  };
  odometry.track(at(0, room().frame(0)));
  CHECK_FALSE(repeats(odometry.track(at(1, room().frame(1)))));
  for (const std::int64_t stamp : {2, 3}) {
    const FrameResult result = odometry.track(at(stamp, room().frame(1)));
    CHECK(result.status == FrameStatus::tracked);
    CHECK(repeats(result));
    CHECK(result.warnings.size() == (stamp == 2 ? 1 : 0));
  }
  CHECK_FALSE(repeats(odometry.track(at(4, room().frame(2)))));
}

TEST_CASE("odometry: a wrong principal point of the right camera is warned of", "[odometry][rig][device]") {
  StereoRig rig = room().rig;
  rig.right.cx -= 4;
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(rig, device, room().config);
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

TEST_CASE("odometry: a right camera that turns during the recording is noticed once, and followed",
          "[odometry][rig][device]") {
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

TEST_CASE("odometry: right images that are displaced from frame to frame are followed, with one warning",
          "[odometry][rig][device]") {
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

TEST_CASE("odometry: one processor gives the same bytes as several", "[odometry][device]") {
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

TEST_CASE("odometry: black frames between two places make two segments, and a third back in the first place",
          "[odometry][device]") {
  const RenderedScene elsewhere("cables", 240, 150, 3);
  Config config = room().config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, elsewhere.config.stereo.max_disparity);
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, config);
  const Image black(240, 150);
  std::vector<StereoFrame> frames;
  for (std::size_t i : {0, 1, 2}) frames.push_back(room().frame(i));
  for (int k = 0; k < 2; ++k) frames.push_back({0, black.view(), black.view()});
  for (std::size_t i : {0, 1, 2}) frames.push_back(elsewhere.frame(i));
  for (std::size_t i : {5, 6, 7}) frames.push_back(room().frame(i));
  std::vector<int> segments, warned;
  std::vector<FrameResult> results;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    results.push_back(odometry.track(at(static_cast<std::int64_t>(i), frames[i])));
    segments.push_back(results[i].segment);
    for (const Warning& warning : results[i].warnings)
      if (warning.kind == WarningKind::unknown_motion) warned.push_back(static_cast<int>(i));
  }
  CHECK(segments == std::vector<int>{0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2});
  CHECK(warned == std::vector<int>{6});  // each kind once
  CHECK_THAT(results[9].message, Catch::Matchers::Contains("segment 2 starts: relocalised against frame 8"));
  for (const auto& [first, truth, index] :
       {std::tuple<std::size_t, const RenderedScene&, std::size_t>{6, elsewhere, 1}, {9, room(), 6}}) {
    const Eigen::Isometry3d motion =
        results[first].world_from_left.value().inverse() * results[first + 1].world_from_left.value();
    check_pose(motion, truth.world_from_left[index].inverse() * truth.world_from_left[index + 1], 6e-3, 0.15);
  }
}

TEST_CASE("odometry: images that do not fit the calibration are lost with a reason, and each warning is given once",
          "[odometry][rig][device]") {
  const RenderedScene scene("room", 320, 200, 3);
  Device device(all_devices().front(), kept_programs());
  StereoOdometry exchanged(scene.rig, device, scene.config);
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
  StereoOdometry doubtful(pitched, device, scene.config);
  for (std::size_t i = 0; i < 3; ++i) {
    const FrameResult result = doubtful.track(scene.frame(i));
    CHECK(is_tracked(result.status));
    REQUIRE(result.warnings.size() == (i == 0 ? 1U : 0U));
    if (i > 0) continue;
    CHECK(result.warnings[0].kind == WarningKind::doubtful_calibration);
    CHECK(result.warnings[0].text.find("doubtful") != std::string::npos);
  }
}

TEST_CASE("odometry: all warnings of one kind come with the first frame that has any", "[odometry][rig]") {
  // Only the left part of both images, so that both principal points lie outside.
  StereoRig cropped = room().rig;
  cropped.left.width = cropped.right.width = 110;
  REQUIRE(cropped.left.cx > 110);
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(cropped, device, room().config);
  for (std::size_t i = 0; i < 3; ++i) {
    StereoFrame frame = room().frame(i);
    frame.left.width = frame.right.width = 110;
    const FrameResult result = odometry.track(frame);
    CHECK(is_tracked(result.status));
    REQUIRE(result.warnings.size() == (i == 0 ? 2U : 0U));
    for (const Warning& warning : result.warnings) CHECK(warning.kind == WarningKind::implausible_calibration);
  }
}

TEST_CASE("odometry: a rig alone is enough, and its disparity range is used", "[odometry][device]") {
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

TEST_CASE("odometry: the disparity range follows the images", "[odometry][device]") {
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

TEST_CASE("odometry: a turn by a third of the view, and one about the optical axis, are found", "[odometry][device]") {
  const auto world = synthetic::make_room(7, room().rig.left.fx);
  const auto render = [&](const Eigen::Isometry3d& camera_from_world) {
    const auto view = synthetic::render(world, room().rig.left, camera_from_world, 3, 0);
    Image image(240, 150);
    for (std::size_t i = 0; i < view.grey.size(); ++i)
      image.pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(view.grey[i]), 0L, 255L));
    return image;
  };
  Eigen::Isometry3d yawed = Eigen::Isometry3d::Identity(), rolled = yawed;
  yawed.linear() = Eigen::AngleAxisd(25 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  yawed.translation() = Eigen::Vector3d(0.1, -0.05, 0.15);
  rolled.linear() = Eigen::AngleAxisd(40 * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const Eigen::Isometry3d& world_from_left : {yawed, rolled}) {
    Device device(all_devices().front(), kept_programs());
    StereoOdometry odometry(room().rig, device, room().config);
    FrameResult result;
    for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d(Eigen::Isometry3d::Identity()), world_from_left}) {
      const Image left = render(pose.inverse()), right = render(room().rig.right_from_left * pose.inverse());
      result = odometry.track({0, left.view(), right.view()});
    }
    CHECK(result.status == FrameStatus::tracked);
    check_pose(result.world_from_left, world_from_left, 0.01, 0.3);
  }
}

TEST_CASE("odometry: a sequence with dark first frames starts at the first frame with edges", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
  const Image black(240, 150);
  CHECK(odometry.track({0, black.view(), black.view()}).status == FrameStatus::lost_too_few_edges);
  CHECK(odometry.track(room().frame(0)).status == FrameStatus::first);
  const auto result = odometry.track(room().frame(1));
  CHECK(result.status == FrameStatus::tracked);
  CHECK(result.reference_frame == 1);
  check_pose(result.world_from_left, room().world_from_left[1], 4e-3, 0.1);
}

TEST_CASE("odometry: before the first frame there are no details", "[odometry][device]") {
  auto names = all_devices();
  names.emplace_back("reference");
  for (const auto& name : names) {
    Device device(name, kept_programs());
    const StereoOdometry odometry(room().rig, device, room().config);
    const FrameDetails details = odometry.details();
    CHECK(details.left_edges.size() == 0);
    CHECK(details.stereo.size() == 0);
    CHECK(details.previous_stereo.size() == 0);
    CHECK(details.quads.size() == 0);
  }
}

TEST_CASE("odometry: empty images and images of another size are refused", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
  const Image small(239, 150);
  CHECK_THROWS_AS(odometry.track({0, small.view(), room().right[0].view()}), DataError);
  CHECK_THROWS_AS(odometry.track({0, room().left[0].view(), small.view()}), DataError);
  CHECK_THROWS_AS(odometry.track({0, {}, {}}), DataError);
  // A refused frame has no effect.
  CHECK(odometry.track(room().frame(0)).status == FrameStatus::first);
  CHECK(odometry.track(room().frame(1)).reference_frame == 0);
}

TEST_CASE("odometry: a stride smaller than a row is refused, for 8 and 16 bits", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoRig deep = room().rig;
  deep.max_value = 65535;
  const Image bytes(240, 150), words(240, 150, 65535);
  for (const auto& [rig, image, row] :
       {std::tuple<StereoRig, ImageView, std::ptrdiff_t>{room().rig, bytes.view(), 240}, {deep, words.view(), 480}}) {
    StereoOdometry odometry(rig, device, room().config);
    for (const std::ptrdiff_t stride : {row - 1, std::ptrdiff_t{0}, -row}) {
      INFO("rows of " << row << " bytes, stride " << stride);
      ImageView narrow = image;
      narrow.stride = stride;
      CHECK_THROWS_AS(odometry.track({0, narrow, image}), DataError);
      CHECK_THROWS_WITH(odometry.track({0, image, narrow}),
                        Catch::Matchers::Contains("right") && Catch::Matchers::Contains(std::to_string(stride)) &&
                            Catch::Matchers::Contains("expected at least the " + std::to_string(row)));
    }
    CHECK_NOTHROW(odometry.track({0, image, image}));
    ImageView narrow = image;
    narrow.stride = row - 1;
    CHECK_THROWS_AS(detect_edges(narrow, device, {}), DataError);
    CHECK_THROWS_AS(detect_edges({}, device, {}), DataError);
  }
}

TEST_CASE("odometry: a timestamp that goes back is refused without effect", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
  CHECK(odometry.track(at(1000, room().frame(0))).status == FrameStatus::first);
  CHECK_THROWS_AS(odometry.track(at(999, room().frame(1))), DataError);
  CHECK_THROWS_WITH(odometry.track(at(-5, room().frame(1))),
                    Catch::Matchers::Contains("-5") && Catch::Matchers::Contains("expected at least 1000"));
  // The refused frame's timestamp does not count, and a repeated timestamp is allowed.
  const auto result = odometry.track(at(1000, room().frame(1)));
  CHECK(result.status == FrameStatus::tracked);
  CHECK(result.reference_frame == 0);
}

TEST_CASE("odometry: after a restart, stamps may go back and a segment starts", "[odometry][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(room().rig, device, room().config);
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

TEST_CASE("odometry: once the scene has been seen, frames allocate nothing on the device", "[odometry][device]") {
  for (const auto& name : all_devices()) {
    Device device(name, kept_programs());
    StereoOdometry odometry(room().rig, device, room().config);
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

TEST_CASE("odometry: without keyframes every frame is tracked against the previous one", "[odometry][device]") {
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

TEST_CASE("odometry: a keyframe is replaced after the maximum number of frames", "[odometry][device]") {
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

TEST_CASE("odometry: edges beyond the capacity are reported", "[odometry][device]") {
  Config config = room().config;
  config.edges.max_edges = 3000;
  for (const auto& name : {std::string("reference"), all_devices().front()}) {
    Device device(name, kept_programs());
    StereoOdometry odometry(room().rig, device, config);
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

TEST_CASE("odometry: cameras of different sizes and orientations track too", "[odometry][device]") {
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
  const auto render = [&](const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_world) {
    const auto view = synthetic::render(world, camera, camera_from_world, 3, 0);
    Image image(camera.width, camera.height);
    for (std::size_t i = 0; i < view.grey.size(); ++i)
      image.pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(view.grey[i]), 0L, 255L));
    return image;
  };
  const synthetic::CameraPath path("ellipse", 7, 4, world.lane);
  for (int i = 0; i < 4; ++i) {
    scene.world_from_left.push_back(path.world_from_left(i));
    const Eigen::Isometry3d left_from_scene = path.scene_from_left(i).inverse();
    scene.left.push_back(render(scene.rig.left, left_from_scene));
    scene.right.push_back(render(scene.rig.right, scene.rig.right_from_left * left_from_scene));
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
