#include <catch2/catch.hpp>

#include "dataset_files.hpp"
#include "frontends.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/odometry.hpp"
#include "rig/image_delay.hpp"
#include "rig/rig_constants.hpp"
#include "rig/rig_monitor.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using dataset_files::real_data;
using matching::RenderedScene;
using rig::RigFindingKind;

namespace {

constexpr double kMaxDisparity = 100;

struct Views {
  StereoRig rig;
  std::vector<Image> left, right;
};

/// The room in a fast flight, and the same images in another order.
const Views& flight() {
  static const Views views = [] {
    const RenderedScene scene("room", 320, 200, 16, 12);
    return Views{scene.rig, scene.left, scene.right};
  }();
  return views;
}

Views recorded(const std::string& path, int frames) {
  const Dataset dataset = open_dataset(path);
  Views views{dataset.rig, {}, {}};
  FramePrefetcher reader(dataset);
  while (auto pair = reader.next()) {
    if (static_cast<int>(views.left.size()) == frames) break;
    views.left.push_back(pair->left);
    views.right.push_back(pair->right);
  }
  return views;
}

/// What a monitor says of each frame if one camera is late by some frames: its delay, or 0.
struct Judged {
  std::vector<int> delays;
  std::string words;     ///< of the last frame refused for its delay
  int false_causes = 0;  ///< frames in which corners off their lines are blamed on the calibration
};

Judged judge(const Views& views, int right_late) {
  rig::RigMonitor monitor(views.rig);
  Judged judged;
  const int frames = static_cast<int>(views.left.size()), skipped = std::abs(right_late);
  for (int i = 0; i + skipped < frames; ++i) {
    const auto left = static_cast<std::size_t>(i + std::max(right_late, 0)),
               right = static_cast<std::size_t>(i + std::max(-right_late, 0));
    const auto report = monitor.judge({i, views.left[left].view(), views.right[right].view()}, {}, 100, kMaxDisparity);
    judged.delays.push_back(0);
    for (const rig::RigFinding& finding : report.findings) {
      judged.false_causes += finding.kind == RigFindingKind::off_lines ? 1 : 0;
      if (finding.kind != RigFindingKind::delayed_images) continue;
      judged.delays.back() = finding.delay.frames;
      judged.words = rig::warning(finding).text;
      CHECK(report.mismatch() != nullptr);
    }
  }
  return judged;
}

/// Frames are refused from the one on in which the partner has been seen, and a right delay is all that is said.
Judged check_late(const Views& views, int right_late, std::size_t passed = 0) {
  INFO(right_late);
  const Judged judged = judge(views, right_late);
  const auto late = static_cast<std::size_t>(std::abs(right_late));
  REQUIRE(judged.delays.size() > late);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < judged.delays.size(); ++i) {
    CHECK((judged.delays[i] == 0 || (i >= late && judged.delays[i] == right_late)));
    refused += judged.delays[i] != 0 ? 1 : 0;
  }
  CHECK(refused + late + passed >= judged.delays.size());
  return judged;
}

}  // namespace

TEST_CASE("image delay: images of one moment have none", "[rig]") {
  const Judged judged = judge(flight(), 0);
  for (const int delay : judged.delays) CHECK(delay == 0);
  CHECK(judged.false_causes == 0);
  for (const char* name : {"cables", "facade"}) {
    INFO(name);
    const RenderedScene scene(name, 320, 200, 9, 3);
    for (const int delay : judge({scene.rig, scene.left, scene.right}, 0).delays) CHECK(delay == 0);
  }
}

TEST_CASE("image delay: a camera that is one, two or seven frames late is refused with its delay", "[rig][long]") {
  const Judged one = check_late(flight(), 1), two = check_late(flight(), -2);
  check_late(flight(), -1);
  check_late(flight(), 2);
  check_late(flight(), 7, 1);
  CHECK_THAT(one.words, Contains("the right camera is 1 frame late") && Contains("taken 1 frame earlier"));
  CHECK_THAT(two.words, Contains("the left camera is 2 frames late") && Contains("the left images are taken"));
  CHECK(one.false_causes == 0);
}

/// At most two frames are tracked once the right camera has become late.
void check_later(const Views& views, std::size_t first, std::size_t late) {
  INFO(late);
  Device device("auto");
  StereoOdometry odometry(views.rig, device);
  int tracked = 0;
  for (std::size_t i = 0; i < views.left.size(); ++i) {
    const Image& right = views.right[i < first ? i : i - late];
    const auto stamp = static_cast<std::int64_t>(i) * 100'000'000;
    const FrameResult result = odometry.track({stamp, views.left[i].view(), right.view()});
    if (i < first) CHECK(result.world_from_left);
    tracked += i >= first && result.world_from_left && !result.ambiguous_motion ? 1 : 0;
  }
  CHECK(tracked <= 2);
}

TEST_CASE("image delay: recordings whose right images become late", "[rig][real][long]") {
  for (const char* name : {"kitti_odometry/sequences/06", "kitti_odometry/sequences/01", "kitti_odometry/sequences/05",
                           "kitti_raw_0926"}) {
    const std::string path = real_data(name);
    if (path.empty()) return;
    INFO(name);
    const Views views = recorded(path, 24);
    for (const std::size_t late : {1, 2, 7}) check_later(views, 15, late);
  }
}

TEST_CASE("image delay: a view that does not change has no delay", "[rig]") {
  Views still = flight();
  std::fill(still.left.begin(), still.left.end(), Image(still.left.front()));
  std::fill(still.right.begin(), still.right.end(), Image(still.right.front()));
  rig::ImageDelayFinder finder;
  const rig::CornerMatcher matcher(still.rig);
  for (int i = 0; i < 4; ++i) {
    const StereoFrame frame{i, still.left[0].view(), still.right[0].view()};
    CHECK_FALSE(finder.find(matcher, frame, kMaxDisparity));
    CHECK_FALSE(finder.measure(matcher, frame, kMaxDisparity, 2));
    finder.keep(frame);
  }
}

TEST_CASE("image delay: a wrong calibration is no delay", "[rig][long]") {
  Views turned = flight();
  turned.rig.right_from_left.linear() = Eigen::AngleAxisd(1.5 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (const int delay : judge(turned, 0).delays) CHECK(delay == 0);
}

TEST_CASE("image delay: recordings whose right images are late by one, two and seven frames", "[rig][real][long]") {
  for (const char* name : {"kitti_odometry/sequences/06", "kitti_odometry/sequences/05", "kitti_raw_0926",
                           "euroc_mh_01_easy", "karlsruhe_drive_0019"}) {
    const std::string path = real_data(name);
    if (path.empty()) return;
    INFO(name);
    const Views views = recorded(path, 16);
    for (const int delay : judge(views, 0).delays) CHECK(delay == 0);
    for (const int late : {1, 2, 7}) check_late(views, late, 2);
  }
}

TEST_CASE("image delay: a delay is forgotten once the images have fitted for long", "[rig]") {
  rig::DelayVotes votes;
  const rig::ImageDelay late{1, 0.9, 0.2};
  votes.add(late);
  CHECK_FALSE(votes.decided());
  votes.add(late);
  CHECK(votes.decided() == 1);
  for (int i = 1; i < rig::kDelayForgotten; ++i) votes.add(std::nullopt);
  CHECK(votes.decided() == 1);
  votes.add(std::nullopt);
  CHECK_FALSE(votes.decided());
  votes.add(late);
  CHECK_FALSE(votes.decided());  // as at the start
}
