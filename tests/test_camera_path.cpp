// The paths of the synthetic camera: smooth, inside their scenes, at the documented speeds, with motion blur.
#include "scenes/path.hpp"
#include "scenes/render.hpp"
#include "scenes/scenes.hpp"
#include "testing.hpp"

using namespace quadedge;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using synthetic::CameraPath;

namespace {

constexpr int kFrames = 200;
const PinholeCamera kCamera{541.764, 541.764, 480.9, 237.6, 942, 489};  // the default camera

double angle(const Isometry3d& from, const Isometry3d& to) {
  return Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
}

/// Displacement of the image centre at a depth of 2.5 m between two phases [px].
double middle_motion(const CameraPath& path, double from, double to) {
  const Vector3d ray = kCamera.ray(Vector2d(0.5 * (kCamera.width - 1), 0.5 * (kCamera.height - 1)));
  const Vector3d point = path.scene_from_left(0.5 * (from + to)) * Vector3d(2.5 * ray);
  return (kCamera.project(path.scene_from_left(to).inverse() * point) -
          kCamera.project(path.scene_from_left(from).inverse() * point))
      .norm();
}

/// Distance [m] to the nearest surface over rays in all directions, and whether every ray hits one.
struct Surroundings {
  double nearest = 1e9;
  bool closed = true;
};
Surroundings look_around(const synthetic::Scene& scene, const Isometry3d& scene_from_camera) {
  constexpr int kRays = 6;  // along each side of a cube face
  Surroundings result;
  for (const auto& [yaw, pitch] : {std::pair(0.0, 0.0), std::pair(0.5, 0.0), std::pair(1.0, 0.0), std::pair(1.5, 0.0),
                                   std::pair(0.0, 0.5), std::pair(0.0, -0.5)}) {
    Isometry3d turn = Isometry3d::Identity();
    turn.linear() =
        (Eigen::AngleAxisd(yaw * kPi, Vector3d::UnitY()) * Eigen::AngleAxisd(pitch * kPi, Vector3d::UnitX()))
            .toRotationMatrix();
    synthetic::VisibleSurfaces parts;
    for (const auto& surface : scene.surfaces) surface((scene_from_camera * turn).inverse(), parts);
    for (int j = 0; j < kRays; ++j) {
      for (int i = 0; i < kRays; ++i) {
        const Vector3d ray((2.0 * i + 1.0) / kRays - 1.0, (2.0 * j + 1.0) / kRays - 1.0, 1.0);
        double inverse = 0.0;
        for (const auto& part : parts) inverse = std::max(inverse, part->inverse_depth(ray));
        if (inverse == 0.0)
          result.closed = false;
        else
          result.nearest = std::min(result.nearest, ray.norm() / inverse);
      }
    }
  }
  return result;
}

}  // namespace

TEST_CASE("camera paths are smooth, start at the identity and are reproducible", "[synthetic]") {
  for (const std::string& name : synthetic_paths()) {
    for (const std::uint64_t seed : {7, 8}) {
      const synthetic::Lane lane{Isometry3d::Identity(), 60.0, 0.25};
      const CameraPath path(name, seed, kFrames, lane), again(name, seed, kFrames, lane);
      CAPTURE(name, seed);
      CHECK(path.world_from_left(0.0).matrix() == Eigen::Matrix4d::Identity());
      for (double phase = 0.0; phase < kFrames - 1; phase += 0.5) {
        const Isometry3d before = path.world_from_left(phase - 0.5), now = path.world_from_left(phase),
                         after = path.world_from_left(phase + 0.5);
        REQUIRE((now.linear().transpose() * now.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
        // The two halves of a frame period differ only by the acceleration.
        const Vector3d first = now.translation() - before.translation(),
                       second = after.translation() - now.translation();
        REQUIRE((second - first).norm() < 0.005);
        REQUIRE(std::abs(angle(now, after) - angle(before, now)) < 0.4 * kDegree);
        REQUIRE(again.world_from_left(phase).matrix() == now.matrix());
      }
      const CameraPath other(name, seed + 1, kFrames, lane);
      CHECK((name == "ellipse") == other.world_from_left(10.0).isApprox(path.world_from_left(10.0), 1e-12));
    }
  }
}

TEST_CASE("the handheld path turns by up to 5 degrees and moves the image by up to 20 px per frame", "[synthetic]") {
  for (const std::uint64_t seed : {7, 8, 9, 10, 11, 12}) {
    const CameraPath path("handheld", seed, kFrames, {});
    double fastest = 0.0, turned = 0.0, way = 0.0;
    for (int frame = 0; frame < 600; ++frame) {
      const Isometry3d now = path.scene_from_left(frame);
      fastest = std::max(fastest, middle_motion(path, frame, frame + 1));
      turned = std::max(turned, Eigen::AngleAxisd(now.linear()).angle());
      const double step = (path.scene_from_left(frame + 1).translation() - now.translation()).norm();
      REQUIRE(step < 0.06);
      way += step;
    }
    CAPTURE(seed, fastest, turned / kDegree, way);
    CHECK(fastest > 15.0);
    CHECK(fastest < 22.0);
    CHECK(turned > 3.5 * kDegree);
    CHECK(turned < 5.0 * kDegree);
    CHECK(way / 30.0 > 0.4);  // m/s
    CHECK(way / 30.0 < 1.0);
  }
}

TEST_CASE("the drive path moves forward along its lane, turning and pitching slowly", "[synthetic]") {
  for (const std::string& name : synthetic_scenes()) {
    const synthetic::Lane lane = synthetic::make_scene(name, 7, 100.0).lane;
    const CameraPath path("drive", 7, kFrames, lane);
    CAPTURE(name);
    double forward = 0.0;
    for (int frame = 0; frame + 1 < path.longest(); ++frame) {
      const Isometry3d step = path.scene_from_left(frame).inverse() * path.scene_from_left(frame + 1);
      const Vector3d way = step.translation();
      REQUIRE(way.z() > 0.8 * lane.step);
      REQUIRE(way.z() < 1.2 * lane.step);
      REQUIRE(std::hypot(way.x(), way.y()) < 0.15 * way.z());
      REQUIRE(angle(path.scene_from_left(frame), path.scene_from_left(frame + 1)) < 1.0 * kDegree);
      forward += way.z();
    }
    CHECK(forward > 0.9 * lane.length);
    CHECK(forward < lane.length);
    SyntheticOptions options;
    options.scene = name;
    options.path = "drive";
    options.frames = path.longest();
    CHECK_NOTHROW(SyntheticSequence(options));
    ++options.frames;
    CHECK_THROWS_AS(SyntheticSequence(options), UsageError);
  }
}

TEST_CASE("the loop returns to its first pose exactly at the last frame, not before", "[synthetic]") {
  for (const int frames : {2, 12, 60, 300}) {
    auto options = rendering(32, 20, 20, frames, 1);
    options.path = "loop";
    options.noise = 0.0;
    const SyntheticSequence sequence(options);
    CAPTURE(frames);
    CHECK(sequence.world_from_left(frames - 1).matrix() == Eigen::Matrix4d::Identity());
    CHECK(sequence.render(frames - 1, Side::right).image.pixels == sequence.render(0, Side::right).image.pixels);
    double way = 0.0, farthest = 0.0;
    for (int frame = 0; frame + 1 < frames; ++frame) {
      const Vector3d here = sequence.world_from_left(frame).translation();
      const double step = (sequence.world_from_left(frame + 1).translation() - here).norm();
      REQUIRE(step < 0.055);
      way += step;
      farthest = std::max(farthest, here.norm());
      if (frame > 0) REQUIRE(here.norm() > 0.0);
    }
    if (frames > 2) CHECK(way > 0.03 * std::min(frames, 75));
    if (frames >= 75) CHECK(farthest > 0.9);
  }
}

// LONG: every scene, path and several seeds.
TEST_CASE("no path leaves its scene or comes near a surface", "[long][synthetic]") {
  for (const std::string& name : synthetic_scenes()) {
    for (const std::uint64_t seed : {7, 23}) {
      const synthetic::Scene scene = synthetic::make_scene(name, seed, 20.0);
      for (const std::string& way : synthetic_paths()) {
        const CameraPath path(way, seed, kFrames, scene.lane);
        const double last = way == "drive" ? path.longest() - 1 : way == "loop" ? kFrames : 400;
        double nearest = 1e9, gap = 0.0;  // [m], between the sampled positions
        Vector3d before = path.scene_from_left(0.0).translation();
        const int places = way == "drive" ? 90 : 30;
        for (int place = 0; place <= places; ++place) {
          Isometry3d camera = path.scene_from_left(last * place / places);
          if (place % 2 == 1) camera = camera * Eigen::Translation3d(0.0598913, 0.0, 0.0);  // the right camera
          const Surroundings around = look_around(scene, camera);
          CAPTURE(name, seed, way, place, around.nearest);
          REQUIRE(around.closed);
          nearest = std::min(nearest, around.nearest);
          gap = std::max(gap, (camera.translation() - before).norm());
          before = camera.translation();
        }
        CAPTURE(name, seed, way, nearest, gap);
        CHECK(nearest > 0.35);
        if (way == "drive" || way == "loop") CHECK(gap < nearest);  // no surface lies between two positions
      }
    }
  }
}

TEST_CASE("no visible surface exceeds the largest disparity, on any path", "[long][synthetic]") {
  for (const std::string& scene : synthetic_scenes()) {
    for (const std::string& path : synthetic_paths()) {
      auto options = rendering(157, 83, 90, path == "ellipse" ? 1000 : 60, 1);
      options.scene = scene;
      options.path = path;
      const SyntheticSequence sequence(options);
      double nearest = 1e9;
      const int step = path == "ellipse" ? 29 : 12;
      for (int frame = 0; frame < options.frames; frame += step)
        for (const float depth : sequence.render(frame, kSides[frame / step % 2]).depth)
          nearest = std::min<double>(nearest, depth);
      REQUIRE(nearest > 0.0);  // every ray hits something
      const double largest = options.focal * options.baseline / nearest, limit = sequence.rig().max_disparity;
      CAPTURE(scene, path, largest, limit);
      CHECK(largest <= limit);
      if (path == "ellipse") CHECK(largest > 0.6 * (limit - 1.0));
    }
  }
}

TEST_CASE("motion blur is the mean over the exposure time", "[synthetic]") {
  StereoRig rig;
  rig.left = rig.right = {60.0, 60.0, 51.3, 30.7, 100, 64};
  rig.right_from_left.translation().x() = -0.06;
  const synthetic::Scene scene = synthetic::make_scene("room", 7, 60.0);
  const CameraPath path("handheld", 7, 10, scene.lane);
  // The default camera's image moves by 8 px per frame; the exposure is a third of a frame period.
  const double mean = path.mean_image_motion(kCamera);
  double sum = 0.0;
  for (int frame = 0; frame < 600; ++frame) sum += middle_motion(path, frame - 0.5, frame + 0.5);
  CHECK(mean == Approx(sum / 600).epsilon(0.03));
  constexpr double kDuration = 1.0 / 3.0;
  for (const int frame : {0, 5}) {
    const auto blurred = synthetic::expose({scene, nullptr, rig, rig.left, path, kDuration, 6, 2}, frame, Side::left);
    const auto sharp = synthetic::expose({scene, nullptr, rig, rig.left, path, 0.0, 6, 2}, frame, Side::left);
    CHECK(blurred.depth == sharp.depth);
    std::vector<double> expected(blurred.grey.size(), 0.0);
    constexpr int kMoments = 25;
    for (int i = 0; i < kMoments; ++i) {
      const double phase = frame + kDuration * ((i + 0.5) / kMoments - 0.5);
      const auto view = synthetic::render(scene, rig.left, path.scene_from_left(phase).inverse(), 3, 2);
      for (std::size_t pixel = 0; pixel < expected.size(); ++pixel) expected[pixel] += view.grey[pixel] / kMoments;
    }
    double difference = 0.0, against_sharp = 0.0;
    for (std::size_t pixel = 0; pixel < expected.size(); ++pixel) {
      difference += std::pow(blurred.grey[pixel] - expected[pixel], 2);
      against_sharp += std::pow(sharp.grey[pixel] - expected[pixel], 2);
    }
    CAPTURE(frame, difference, against_sharp);
    CHECK(difference < 0.1 * against_sharp);
  }
}

TEST_CASE("a blur longer than the path's motion in a frame is refused, naming the largest one", "[synthetic]") {
  for (const std::string& path : synthetic_paths()) {
    SyntheticOptions options;
    options.path = path;
    options.frames = 50;
    options.blur = 49.0;
    CAPTURE(path);
    CHECK_THROWS_WITH(SyntheticSequence(options), Catch::Matchers::Contains("path " + path) &&
                                                      Catch::Matchers::Contains("blur = 49, allowed: 0 to "));
    const synthetic::Scene scene = synthetic::make_scene("room", options.seed, options.focal);
    options.blur = 0.99 * CameraPath(path, options.seed, options.frames, scene.lane)
                              .mean_image_motion(SyntheticSequence(SyntheticOptions()).rig().left);
    CHECK_NOTHROW(SyntheticSequence(options));
    options.blur /= 0.98;
    CHECK_THROWS_AS(SyntheticSequence(options), UsageError);
  }
}
