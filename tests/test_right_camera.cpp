#include <Eigen/Geometry>

#include "common/calibration.hpp"
#include "devices.hpp"
#include "frontends.hpp"
#include "matching.hpp"
#include "odometry/right_camera.hpp"
#include "quadedge/odometry.hpp"

using namespace quadedge;
using namespace matching;

namespace {

const StereoRig& calibrated() {
  static const StereoRig rig = flat_rig(640, 480, 500, 0.1);
  return rig;
}

/// Where a right camera that is turned against the calibration by `turn` [degrees], and whose lens moves points away
/// from its axis by cubic r^3, sees a point of the left frame [px].
Eigen::Vector2d seen(const Eigen::Vector3d& point, const Eigen::Vector3d& turn, double cubic) {
  const Eigen::Vector3d in_right =
      rotation_by(-turn * kDegree) * (point + Eigen::Vector3d(calibrated().right_from_left.translation()));
  const Eigen::Vector2d ideal = in_right.hnormalized();
  const Eigen::Vector2d moved = ideal * (1 + cubic * ideal.squaredNorm());
  return calibrated().right.project(moved.homogeneous());
}

Eigen::Vector3d anywhere(Random& random) {
  return random(2, 30) * calibrated().left.ray({random(60, 580), random(20, 460)});
}

/// The rows of some frames of that camera, up to uniform noise of 0.2 px.
rig::RowModel rows_of(const Eigen::Vector3d& turn, double cubic, int frames = 12) {
  Random random(5);
  rig::RowModel rows(calibrated().right);
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<rig::CornerMatch> matches(200);
    for (rig::CornerMatch& match : matches) {
      const Eigen::Vector3d point = anywhere(random);
      match.right = seen(point, turn, cubic);
      match.across = match.right.y() - seen(point, {0, 0, 0}, 0).y() + random(-0.2, 0.2);
    }
    rows.add(matches);
  }
  return rows;
}

odometry::RightCamera claimed_by(const rig::RowModel& rows) {
  odometry::RightCamera camera;
  camera.claim(rows, calibrated());
  return camera;
}

}  // namespace

TEST_CASE("right camera: from rows follows what moves columns, but for their common offset", "[odometry][rig]") {
  for (const auto& [turn, cubic] :
       {std::pair(Eigen::Vector3d(0, 0.3, 0), 0.0), std::pair(Eigen::Vector3d(0.3, 0, 0), 0.0),
        std::pair(Eigen::Vector3d(0, 0, 0), 0.005), std::pair(Eigen::Vector3d(-0.2, 0.2, 0), -0.004)}) {
    CAPTURE(turn.transpose(), cubic);
    const RightCameraError error = rows_of(turn, cubic).camera_error();
    CHECK(error.yaw == Approx(turn.y() * kDegree).epsilon(0.1));
    CHECK(error.pitch == Approx(turn.x() * kDegree).epsilon(0.1));
    Random random(7);
    const double middle = seen({0, 0, 10}, turn, cubic).x() - seen({0, 0, 10}, {0, 0, 0}, 0).x();
    double worst = 0, largest = 0;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d point = anywhere(random);
      const Eigen::Vector2d at = seen(point, turn, cubic);
      const double moved = at.x() - seen(point, {0, 0, 0}, 0).x() - middle;
      largest = std::max(largest, std::abs(moved));
      worst = std::max(worst, std::abs(error.column(calibrated().right, at.x(), at.y()) - moved));
    }
    CHECK(largest > 0.3);
    CHECK(worst < 0.15 * largest);
  }
  CHECK(rows_of({0, 0, 0.3}, 0).camera_error().is_zero());  // a roll moves columns otherwise, as the search allows for
  CHECK(rows_of({0, 0, 0}, 0).camera_error().is_zero());
  CHECK(rows_of({0, 0.3, 0}, 0, 2).camera_error().is_zero());  // too few frames
}

TEST_CASE("right camera: two frames whose motions agree confirm what rows say", "[odometry][rig]") {
  const rig::RowModel rows = rows_of({0, 0.3, 0}, 0);
  odometry::RightCamera camera = claimed_by(rows);
  REQUIRE(camera.is_open());
  CHECK_FALSE(camera.weigh(500));
  CHECK_FALSE(camera.is_open());  // until the next frame
  CHECK(camera.error().is_zero());
  camera.claim(rows, calibrated());
  REQUIRE(camera.is_open());
  CHECK(camera.weigh(500));
  CHECK(camera.error().yaw == rows.camera_error().yaw);
  camera.claim(rows, calibrated());
  CHECK_FALSE(camera.is_open());
  CHECK_FALSE(camera.error().is_zero());
  // Rows that are learned anew take it back.
  camera.claim(rows_of({0, 0, 0}, 0, 4), calibrated());
  CHECK(camera.error().is_zero());
}

TEST_CASE("right camera: what motions deny is not asked again until rows are learned anew", "[odometry][rig]") {
  const rig::RowModel rows = rows_of({0, 0.3, 0}, 0);
  odometry::RightCamera camera = claimed_by(rows);
  CHECK_FALSE(camera.weigh(-500));
  camera.claim(rows, calibrated());
  CHECK_FALSE(camera.weigh(-500));
  for (const auto& later : {rows, rows_of({0.3, 0.3, 0}, 0, 20)}) {
    camera.claim(later, calibrated());
    CHECK_FALSE(camera.is_open());
    CHECK(camera.error().is_zero());
  }
  camera.claim(rows_of({0, 0.3, 0}, 0, 4), calibrated());
  CHECK(camera.is_open());
}

TEST_CASE("right camera: motions that say little are compared in ten frames at most", "[odometry][rig]") {
  const rig::RowModel rows = rows_of({0, 0.3, 0}, 0);
  odometry::RightCamera camera;
  int compared = 0;
  for (int frame = 0; frame < 30; ++frame) {
    camera.claim(rows, calibrated());
    if (!camera.is_open()) break;
    camera.weigh(frame % 2 == 0 ? 30 : -30);
    ++compared;
  }
  CHECK(compared == 10);
  CHECK(camera.error().is_zero());
}

TEST_CASE("right camera: rows that differ as between two recordings with one rig claim nothing", "[odometry][rig]") {
  CHECK_FALSE(claimed_by(rows_of({0, 0.02, 0}, 0)).is_open());
  StereoRig vertical = calibrated();
  vertical.right_from_left.translation() = Eigen::Vector3d(0, -0.1, 0);
  odometry::RightCamera camera;
  camera.claim(rows_of({0, 0.3, 0}, 0), vertical);
  CHECK_FALSE(camera.is_open());
}

TEST_CASE("right camera: a run corrects one that is turned against its calibration, with a warning",
          "[odometry][rig][device]") {
  static const RenderedScene scene("room", 400, 250, 10);
  const auto mean_error = [&](double yaw, int& warned, RightCameraError& found) {
    StereoRig rig = scene.rig;
    rig.right_from_left.linear() = rotation_by({0, yaw * kDegree, 0});  // of a camera turned the other way
    Device device(all_devices().front(), kept_programs());
    StereoOdometry odometry(rig, device, scene.config);
    std::vector<FrameResult> results;
    for (std::size_t i = 0; i < scene.left.size(); ++i) results.push_back(odometry.track(scene.frame(i)));
    double sum = 0;
    for (std::size_t i = 6; i < results.size(); ++i) {
      REQUIRE(results[i].world_from_left);
      const Eigen::Isometry3d motion = results[i - 1].world_from_left->inverse() * *results[i].world_from_left,
                              truth = scene.world_from_left[i - 1].inverse() * scene.world_from_left[i];
      sum += (motion.translation() - truth.translation()).norm() / 4;
    }
    warned = 0;
    for (const FrameResult& result : results)
      for (const Warning& warning : result.warnings)
        warned += warning.kind == WarningKind::corrected_right_camera ? 1 : 0;
    found = results.back().right_error;
    return sum;
  };
  int warned = 0;
  RightCameraError found;
  const double sound = mean_error(0, warned, found);
  CHECK(warned == 0);
  CHECK(found.is_zero());
  const double turned = mean_error(0.4, warned, found);
  CHECK(warned == 1);
  CHECK(found.yaw == Approx(0.4 * kDegree).epsilon(0.15));
  INFO("mean error of a step, sound and turned " << 1e3 * sound << ", " << 1e3 * turned << " mm");
  CHECK(turned < 2 * sound);
}
