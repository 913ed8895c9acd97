#include "calibration/image_delay.hpp"
#include "dataset_files.hpp"
#include "frontends.hpp"
#include "rig/rig_monitor.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using dataset_files::real_data;
using matching::RenderedScene;

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

/// What a monitor says of a recording in which one camera is late by some frames.
struct Judged {
  std::vector<bool> refused;  ///< per frame, for whatever reason
  std::string words;          ///< of the last sentence about time
};

Judged judge(const Views& views, int right_late) {
  rig::RigMonitor monitor(views.rig);
  Judged judged;
  const int frames = static_cast<int>(views.left.size()), skipped = std::abs(right_late);
  for (int i = 0; i + skipped < frames; ++i) {
    const auto left = static_cast<std::size_t>(i + std::max(right_late, 0)),
               right = static_cast<std::size_t>(i + std::max(-right_late, 0));
    const auto report = monitor.judge({i, views.left[left].view(), views.right[right].view()}, {}, 100, kMaxDisparity);
    judged.refused.push_back(report.mismatch() != nullptr);
    for (const rig::RigFinding& finding : report.findings)
      if (finding.warning.kind == WarningKind::unsynchronised_cameras) judged.words = finding.warning.text;
  }
  return judged;
}

void check_sound(const Views& views) {
  const Judged judged = judge(views, 0);
  CHECK(judged.words.empty());
  CHECK(std::count(judged.refused.begin(), judged.refused.end(), true) == 0);
}

/// What `quadedge check` says of it, if it looks at every pair.
std::string delay_of(const Views& views, int right_late) {
  rig::ImageDelaySearch search;
  const int frames = static_cast<int>(views.left.size()), skipped = std::abs(right_late);
  for (int i = 0; i + skipped < frames; ++i)
    search.add(views.rig, views.left[static_cast<std::size_t>(i + std::max(right_late, 0))],
               views.right[static_cast<std::size_t>(i + std::max(-right_late, 0))], kMaxDisparity, true);
  return search.text();
}

Views pitched(const Views& views, double degrees) {
  Views result = views;
  result.rig.right_from_left.linear() =
      Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return result;
}

}  // namespace

TEST_CASE("image delay: images of one moment have none", "[rig]") {
  check_sound(flight());
  CHECK(delay_of(flight(), 0).empty());
  for (const char* name : {"cables", "facade"}) {
    INFO(name);
    const RenderedScene scene(name, 320, 200, 9, 3);
    check_sound({scene.rig, scene.left, scene.right});
  }
}

TEST_CASE("image delay: a pitched camera is not late", "[rig]") {
  const RenderedScene scene("room", 480, 249, 16);
  for (const double degrees : {0.1, 0.15, 0.2, -0.2, 0.3, 0.4, 0.5}) {
    INFO(degrees);
    const Views turned = pitched({scene.rig, scene.left, scene.right}, degrees);
    check_sound(turned);
    if (degrees == 0.2) CHECK(delay_of(turned, 0).empty());
  }
}

TEST_CASE("image delay: frames of a camera that is late are refused once the image has moved", "[rig][long]") {
  for (const int late : {1, -1, 2, -2, 7}) {
    INFO(late);
    const Judged judged = judge(flight(), late);
    CHECK(std::count(judged.refused.begin(), judged.refused.end(), false) <= (late == -1 || late == 7 ? 4 : 2));
    if (std::abs(late) == 1) CHECK_THAT(judged.words, Contains(late > 0 ? "the right camera" : "the left camera"));
  }
}

TEST_CASE("image delay: a pair that a driver mixed up costs no frame that fits", "[rig]") {
  Views mixed = flight();
  for (const std::size_t i : {6, 7}) mixed.right[i] = flight().right[i - 1];
  const Judged judged = judge(mixed, 0);
  for (std::size_t i = 8; i < judged.refused.size(); ++i) CHECK_FALSE(judged.refused[i]);
}

TEST_CASE("image delay: check finds by how many frames a camera is late", "[rig][long]") {
  CHECK_THAT(delay_of(flight(), 1), Contains("the right camera is 1 frame late") && Contains("taken 1 frame earlier"));
  CHECK_THAT(delay_of(flight(), -2), Contains("the left camera is 2 frames late") && Contains("the left images are"));
  CHECK_THAT(delay_of(flight(), 7), Contains("the right camera is 7 frames late"));
  CHECK(delay_of(pitched(flight(), 1.5), 0).empty());
  Views still = flight();
  std::fill(still.left.begin(), still.left.end(), Image(still.left.front()));
  std::fill(still.right.begin(), still.right.end(), Image(still.right.front()));
  CHECK(delay_of(still, 0).empty());
}

TEST_CASE("image delay: what masks hide has no say", "[rig]") {
  // Texture that is burnt into both images fits whatever they are paired with.
  Views burnt = flight();
  const int first = burnt.rig.left.height / 4;
  const Image over = burnt.left.front();
  for (auto* images : {&burnt.left, &burnt.right})
    for (Image& image : *images)
      std::copy(over.pixels.begin() + first * over.width, over.pixels.end(), image.pixels.begin() + first * over.width);
  CHECK(delay_of(burnt, 1).empty());
  PixelMask mask{over.width, over.height, std::vector<std::uint8_t>(over.pixels.size(), 0)};
  std::fill(mask.hidden.begin() + (first - 10) * over.width, mask.hidden.end(), std::uint8_t{1});
  burnt.rig.left_mask = burnt.rig.right_mask = mask;
  CHECK_THAT(delay_of(burnt, 1), Contains("the right camera is 1 frame late"));
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

TEST_CASE("image delay: recordings are not late, and check finds by how much their right images are",
          "[rig][real][long]") {
  for (const char* name : {"kitti_odometry/sequences/06", "kitti_odometry/sequences/05", "kitti_raw_0926",
                           "euroc_mh_01_easy", "karlsruhe_drive_0019"}) {
    const std::string path = real_data(name);
    if (path.empty()) return;
    INFO(name);
    const Views views = recorded(path, 12);
    check_sound(views);
    CHECK_THAT(delay_of(views, 1), Contains("the right camera is 1 frame late"));
  }
}
