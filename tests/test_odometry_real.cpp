/// \file test_odometry_real.cpp  Recorded sequences compared with their published poses. Needs QUADEDGE_DATA.
#include "dataset_files.hpp"

using namespace quadedge;
using dataset_files::real_data;

namespace {

struct TrackedFrames {
  Trajectory tracked;
  std::vector<FrameResult> results;
};

/// Tracks the frames of a data set with its reader's disparity range.
TrackedFrames track_dataset(const Dataset& dataset, const std::map<std::string, std::string>& variants = {}) {
  Config config;
  config.variants = variants;
  Device device("auto", kept_programs());
  StereoOdometry odometry(dataset.rig, device, config);
  FramePrefetcher frames(dataset);
  TrackedFrames run;
  while (const auto frame = frames.next()) {
    run.results.push_back(odometry.track(frame->view()));
    if (is_tracked(run.results.back().status))
      run.tracked.push_back({frame->stamp_ns, *run.results.back().world_from_left, run.results.back().segment});
  }
  return run;
}

bool same_bytes(const TrackedFrames& a, const TrackedFrames& b) {
  if (a.tracked.size() != b.tracked.size()) return false;
  for (std::size_t i = 0; i < a.tracked.size(); ++i) {
    if (std::memcmp(a.tracked[i].world_from_left.data(), b.tracked[i].world_from_left.data(), 16 * sizeof(double)) != 0)
      return false;
  }
  return true;
}

}  // namespace

TEST_CASE("recordings: every frame is tracked, within limits of the mean errors", "[real][device]") {
  struct Row {
    const char* path;
    std::size_t frames;
    double rpe_metres, rpe_degrees, ape_metres, ape_degrees;
  };
  constexpr double kAny = 1e9;
  for (const Row& row : {Row{"kitti_odometry/sequences/06", 36, 0.02, 0.07, kAny, kAny},
                         {"kitti_odometry/sequences/01", 25, kAny, 0.06, kAny, kAny},
                         {"euroc_v1_01_easy_at_rest", 40, kAny, kAny, 0.003, 0.2}}) {
    INFO(row.path);
    const std::string path = real_data(row.path);
    if (path.empty()) continue;
    const Dataset dataset = open_dataset(path);
    const TrackedFrames run = track_dataset(dataset);
    REQUIRE(run.tracked.size() == row.frames);
    CHECK(run.results.size() == row.frames);
    const auto errors = evaluate_trajectory(run.tracked, dataset.truth).origin_aligned;
    CHECK(errors.rpe_translation_m.mean <= row.rpe_metres);
    CHECK(errors.rpe_rotation_deg.mean <= row.rpe_degrees);
    CHECK(errors.ape_translation_m.mean <= row.ape_metres);
    CHECK(errors.ape_rotation_deg.mean <= row.ape_degrees);
  }
}

TEST_CASE("EuRoC key frames: every unknown motion starts a segment, and each segment is right by itself",
          "[real][device]") {
  const std::string path = real_data("euroc_v1_01_easy_keyframes");
  if (path.empty()) return;
  DatasetOptions options;
  options.first_frame = 40;
  options.last_frame = 64;
  const Dataset dataset = open_dataset(path, options);
  const TrackedFrames run = track_dataset(dataset);
  const TrajectoryEvaluation whole = evaluate_trajectory(run.tracked, dataset.truth);
  REQUIRE(run.results.back().segment > 0);
  REQUIRE(whole.segments.size() == static_cast<std::size_t>(run.results.back().segment) + 1);
  CHECK(whole.origin_aligned.ape_rotation_deg.max > 5);  // the unknown motions
  for (const TrajectoryEvaluation& segment : whole.segments) {
    INFO("segment " << segment.segment << ", " << segment.matched << " poses");
    if (segment.matched < 2) continue;
    CHECK(segment.end_drift_percent < 3);
    CHECK(segment.origin_aligned.rpe_translation_m.max < 0.05);
    CHECK(segment.origin_aligned.rpe_rotation_deg.max < 2);
  }
  // A new segment starts with the frame after a lost one, and with nothing else.
  for (std::size_t i = 1; i < run.results.size(); ++i) {
    const FrameResult &before = run.results[i - 1], &result = run.results[i];
    const bool starts = result.segment != before.segment;
    CHECK(starts == (result.message.find("segment " + std::to_string(result.segment) + " starts") == 0));
    if (starts) CHECK((!is_tracked(before.status) && is_tracked(result.status)));
  }
}

TEST_CASE("Karlsruhe quad: 0.25 m and 0.61 degrees within 10 percent", "[real][device]") {
  const std::string path = real_data("karlsruhe_quad");
  if (path.empty()) return;
  const TrackedFrames run = track_dataset(open_dataset(path));
  REQUIRE(run.tracked.size() == 2);
  const Eigen::Isometry3d motion = run.tracked[0].world_from_left.inverse() * run.tracked[1].world_from_left;
  CHECK(motion.translation().norm() == Approx(0.25).epsilon(0.1));
  CHECK(Eigen::AngleAxisd(motion.linear()).angle() * 180 / kPi == Approx(0.61).epsilon(0.1));
}

TEST_CASE("KITTI 06: the same bytes again, with other local sizes and other variants", "[real][device]") {
  const std::string path = real_data("kitti_odometry/sequences/06");
  if (path.empty()) return;
  DatasetOptions options;
  options.first_frame = 10;
  options.last_frame = 13;
  const Dataset dataset = open_dataset(path, options);
  const TrackedFrames run = track_dataset(dataset);
  REQUIRE(run.tracked.size() == 3);
  CHECK(same_bytes(run, track_dataset(dataset)));
  CHECK(same_bytes(run, track_dataset(dataset, {{"stereo_refinement", "lanes64"},
                                                {"stereo_relaxation", "group64"},
                                                {"point_index", "items64"},
                                                {"temporal_match", "rows32"}})));
  CHECK(same_bytes(
      run,
      track_dataset(dataset,
                    {{"edge_detection", "tile64"}, {"scan", "group256"}, {"patches", "lanes"}, {"sift", "cells"}})));
}

TEST_CASE("KITTI 06: no step behind a moving board of random dots over 60 % is wrong without a flag",
          "[real][device]") {
  const std::string path = real_data("kitti_odometry/sequences/06");
  if (path.empty()) return;
  const Dataset dataset = open_dataset(path);
  const int width = dataset.rig.left.width, height = dataset.rig.left.height, dot = 3, disparity = 25, speed = 4;
  const double reach = std::sqrt(0.6) / 2;
  std::mt19937 random(101);
  std::vector<int> bright(700 * 400);
  for (int& each : bright) each = static_cast<int>(random() % 2);
  const auto paint = [&](Image& image, int shift, int moved) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int u = x + shift, noise = static_cast<int>(random() % 7) - 3;
        if (std::abs(u - width / 2) > reach * width || std::abs(y - height / 2) > reach * height) continue;
        const int place = y / dot * 700 + (u + moved) / dot;
        image.pixels[static_cast<std::size_t>(y * width + x)] =
            static_cast<std::uint8_t>((bright[static_cast<std::size_t>(place)] != 0 ? 220 : 30) + noise);
      }
  };
  Device device("auto", kept_programs());
  StereoOdometry odometry(dataset.rig, device, Config());
  FramePrefetcher frames(dataset);
  std::vector<bool> is_told, is_right;
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  for (int number = 0; number < 20; ++number) {
    auto frame = frames.next();
    REQUIRE(frame);
    if (number < 10) continue;
    paint(frame->left, 0, speed * number);
    paint(frame->right, disparity, speed * number);
    const FrameResult result = odometry.track(frame->view());
    const Eigen::Isometry3d pose = result.world_from_left.value_or(before);
    is_right.push_back(std::abs((before.inverse() * pose).translation().z() - 1.19) < 0.12);  // a step's length
    is_told.push_back(!is_tracked(result.status) || result.ambiguous_motion);
    before = pose;
  }
  int wrong = 0, silent = 0;
  for (std::size_t i = 1; i < is_told.size(); ++i) {
    wrong += is_right[i] ? 0 : 1;
    silent += is_right[i] || is_told[i - 1] || is_told[i] ? 0 : 1;
  }
  CHECK(wrong > 0);  // else the board hides less than it should
  CHECK(silent == 0);
}
