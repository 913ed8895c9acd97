#include "common/numeric.hpp"
#include "frontends.hpp"
#include "generated_quads.hpp"
#include "geometry/corrected_rig.hpp"
#include "geometry/oriented_point.hpp"
#include "motion/latest_frame.hpp"
#include "motion/motion_search.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Frames of the room, rendered once.
const RenderedScene& estimated_room() {
  static const RenderedScene scene("room", 240, 150, 8);
  return scene;
}

/// The image as a camera sees it that is displaced: contents lie farther left by some columns.
Image displaced(const Image& from, int columns) {
  Image to = from;
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x)
      to.set(x, y, from.pixels[static_cast<std::size_t>(y * from.width + std::clamp(x + columns, 0, from.width - 1))]);
  return to;
}

/// The texture of a surface that does not move.
int bonnet(int x, int y) {
  std::minstd_rand random(static_cast<unsigned>(1 + x / 6 + 1000 * (y / 6)));
  random.discard(3);
  return static_cast<int>(40 + random() % 160);
}

/// The lower third of the images, nearer than the facade that passes, does not move.
std::vector<std::pair<Image, Image>> bonnet_before_a_facade() {
  std::vector<std::pair<Image, Image>> frames;
  const RenderedScene facade("facade", estimated_room().rig.left.width, estimated_room().rig.left.height, 24, 2);
  for (std::size_t i = 0; i < 24; ++i) {
    Image left = facade.left[i], right = facade.right[i];
    for (int y = 2 * left.height / 3; y < left.height; ++y)
      for (int x = 0; x < left.width; ++x) {
        left.set(x, y, bonnet(x, y));
        right.set(x, y, bonnet(x + 20, y));
      }
    frames.emplace_back(left, right);
  }
  return frames;
}

StereoFrame stamped(std::int64_t stamp_ns, StereoFrame frame) {
  frame.stamp_ns = stamp_ns;
  return frame;
}

double median_depth(const Eigen::Matrix3Xd& points) {
  std::vector<double> depths;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (points(2, i) > 0) depths.push_back(points(2, i));
  return upper_median(depths);
}

/// Points of the frame tracked last, as they are written.
double median_depth(const StereoFrame& frame, const FrameResult& result, const StereoOdometry& odometry) {
  PointCloudOptions options;
  options.min_views = 1;
  PointCloud cloud(odometry.config(), options);
  REQUIRE(cloud.add(frame, result, odometry));
  std::vector<double> depths;
  for (const CloudPoint& point : cloud.points())
    depths.push_back((result.world_from_left->inverse() * point.position).z());
  return upper_median(depths);
}

}  // namespace

TEST_CASE("rig estimate: the corrected rig reconstructs points nearer by what is added to disparities", "[rig]") {
  RigEstimate estimate;
  estimate.disparity_offset = 0.5;
  estimate.displacement = 0.3;
  CHECK(estimate.added_disparity() == Approx(0.2));
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    const pose::OrientedPoint point{{0.1, -0.05, 6}, Eigen::Vector3d(0.5, 0.8, 0.2).normalized()};
    const auto seen = generated::observe(rig, point);
    const auto before = pose::measure(rig, seen, 0.05), after = pose::measure(corrected_rig(rig, estimate), seen, 0.05);
    REQUIRE((before && after));
    CHECK(after->inverse_depth - before->inverse_depth == Approx(0.2 * before->inverse_depth_per_pixel).epsilon(0.02));
  }
}

TEST_CASE("rig estimate: a known offset holds for the first frame and for the first after a restart", "[rig][device]") {
  // A calibration whose right principal point is 0.8 px off, which is known.
  StereoRig off = estimated_room().rig;
  off.right.cx += 0.8;
  Config known = estimated_room().config;
  known.pose.disparity_offset = -0.8;
  known.pose.disparity_offset_sigma = 0;
  Device device(all_devices().front(), kept_programs());
  StereoOdometry right(estimated_room().rig, device, estimated_room().config), odometry(off, device, known);
  const double truth = median_depth(estimated_room().frame(0), right.track(estimated_room().frame(0)), right);
  for (int part = 0; part < 2; ++part) {
    const FrameResult first = odometry.track(stamped(0, estimated_room().frame(0)));
    REQUIRE(first.status == FrameStatus::first);
    CHECK(first.rig.disparity_offset == -0.8);
    CHECK(median_depth(estimated_room().frame(0), first, odometry) == Approx(truth).epsilon(1e-3));
    const FrameDetails details = odometry.details();
    CHECK(median_depth(edge_points(details.stereo, odometry.rig(), details.rig).position) ==
          Approx(median_depth(edge_points(right.stereo_edges(), right.rig()).position)).epsilon(1e-3));
    CHECK(odometry.track(stamped(1, estimated_room().frame(1))).status == FrameStatus::tracked);
    odometry.restart();
  }
}

TEST_CASE("rig estimate: disparity errors are hundredths of a pixel with the true calibration", "[rig][device]") {
  Device device(all_devices().front(), kept_programs());
  StereoRig off = estimated_room().rig;
  off.right.fx *= 1.02;  // disparities are wrong by up to 2.4 px, at the sides
  StereoOdometry right(estimated_room().rig, device, estimated_room().config),
      wrong(off, device, estimated_room().config);
  const double before = right.track(estimated_room().frame(0)).rig.disparity_error;
  CHECK(wrong.track(estimated_room().frame(0)).rig.disparity_error == before);
  double with_right = 0, with_wrong = 0;
  for (std::size_t i = 1; i < 8; ++i) {
    with_right = right.track(estimated_room().frame(i)).rig.disparity_error;
    with_wrong = wrong.track(estimated_room().frame(i)).rig.disparity_error;
  }
  CHECK(with_right < 0.08);
  CHECK(with_wrong > 1.15 * before);
  wrong.restart();
  CHECK(wrong.track(stamped(0, estimated_room().frame(0))).rig.disparity_error == before);
}

TEST_CASE("rig estimate: the points and the kept edges of a displaced keyframe are those of its rig", "[rig][device]") {
  Config config = estimated_room().config;
  config.odometry.key_rig = false;  // every frame becomes one
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(estimated_room().rig, device, config), sound(estimated_room().rig, device, config);
  Map map(odometry);
  FrameResult result, undisturbed;
  for (std::size_t i = 0; i < 4; ++i) {
    const Image right = displaced(estimated_room().right[i], i == 3 ? 3 : 0);
    result = odometry.track({estimated_room().frame(i).stamp_ns, estimated_room().left[i].view(), right.view()});
    undisturbed = sound.track(estimated_room().frame(i));
    map.add(result);
  }
  REQUIRE(result.new_key_rig);
  CHECK(result.rig.displacement == Approx(3).margin(0.3));
  CHECK(result.rig.displacement_sigma > 0);
  const double truth = median_depth(edge_points(sound.stereo_edges(), sound.rig(), undisturbed.rig).position);
  const FrameDetails details = odometry.details();
  CHECK(details.rig.displacement == result.rig.displacement);
  CHECK(details.previous_rig.displacement == 0);
  CHECK(median_depth(edge_points(details.stereo, odometry.rig(), details.rig).position) == Approx(truth).epsilon(0.02));
  CHECK(std::abs(median_depth(edge_points(details.stereo, odometry.rig()).position) / truth - 1) > 0.05);
  const double seen = median_depth(estimated_room().frame(3), undisturbed, sound);
  CHECK(median_depth({0, estimated_room().left[3].view(), estimated_room().right[3].view()}, result, odometry) ==
        Approx(seen).epsilon(0.02));
  // What a map keeps of it.
  const auto latest = odometry::LatestFrame::of(odometry);
  const frontend::KeptFrameEdges kept = frontend::as_global(latest.frontend).keep();
  CHECK(kept.rig.displacement == result.rig.displacement);
  CHECK(frontend::as_global(latest.frontend).restore(kept)->rig().displacement == result.rig.displacement);
}

TEST_CASE("rig estimate: a saved map of displaced keyframes locates images that are not displaced", "[rig][device]") {
  Config config = estimated_room().config;
  config.odometry.key_rig = false;
  config.map.min_gap = 1;
  config.pose.disparity_offset_sigma = 0;
  Device device(all_devices().front(), kept_programs());
  StereoOdometry odometry(estimated_room().rig, device, config);
  Map map(odometry);
  for (std::size_t i = 0; i < 8; ++i) {
    const Image right = displaced(estimated_room().right[i], i < 3 ? 0 : 3);  // told where a motion is predicted
    const FrameResult result =
        odometry.track({estimated_room().frame(i).stamp_ns, estimated_room().left[i].view(), right.view()});
    CHECK((result.rig.displacement != 0) == (i >= 3));
    map.add(result);
  }
  Localiser localiser(map.saved(), estimated_room().rig, device, config);
  for (const std::size_t i : {3, 5, 7}) {
    const Localisation found = localiser.locate(estimated_room().frame(i));
    REQUIRE(found.map_from_left);
    const Eigen::Isometry3d truth = estimated_room().world_from_left[0].inverse() * estimated_room().world_from_left[i];
    CHECK((found.map_from_left->translation() - truth.translation()).norm() < 0.03);
  }
}

TEST_CASE("rig estimate: nothing of the frames before a restart is left", "[rig][odometry][device]") {
  Config config = estimated_room().config;
  config.pose.disparity_offset_sigma = 0;  // the offset learned is the rig's, and stays
  Device device(all_devices().front(), kept_programs());
  struct Ending {
    const char* name;
    std::vector<std::pair<Image, Image>> frames;
    bool (*is_reached)(const FrameResult&);
  };
  std::vector<Ending> endings(3);
  endings[0] = {"displaced", {}, [](const FrameResult& result) { return result.rig.displacement != 0; }};
  for (std::size_t i = 0; i < 5; ++i)
    endings[0].frames.emplace_back(estimated_room().left[i], displaced(estimated_room().right[i], i == 4 ? 3 : 0));
  // The right half of both images moves on its own.
  endings[1] = {"ambiguous", {}, [](const FrameResult& result) { return result.ambiguous_motion; }};
  for (std::size_t i = 0; i < 7; ++i) {
    Image left = estimated_room().left[i], right = estimated_room().right[i];
    for (int y = 0; y < left.height; ++y) {
      for (int x = left.width / 2; x < left.width; ++x) {
        const auto pixel = static_cast<std::size_t>(y * left.width + x);
        left.pixels[pixel] = estimated_room().left[7 - i].pixels[pixel];
        right.pixels[pixel] = estimated_room().right[7 - i].pixels[pixel];
      }
    }
    endings[1].frames.emplace_back(left, right);
  }
  endings[2] = {"masked", {}, [](const FrameResult& result) {
                  return std::any_of(result.warnings.begin(), result.warnings.end(),
                                     [](const Warning& warning) { return warning.kind == WarningKind::static_region; });
                }};
  endings[2].frames = bonnet_before_a_facade();
  for (const Ending& ending : endings) {
    INFO(ending.name);
    StereoOdometry fresh(estimated_room().rig, device, config), restarted(estimated_room().rig, device, config);
    bool is_reached = false;
    for (std::size_t i = 0; i < ending.frames.size(); ++i) {
      const auto& [left, right] = ending.frames[i];
      const FrameResult result = restarted.track({static_cast<std::int64_t>(i), left.view(), right.view()});
      is_reached = is_reached || ending.is_reached(result);
    }
    REQUIRE(is_reached);
    restarted.restart();
    for (std::size_t i = 0; i < 8; ++i) {
      CAPTURE(i);
      const auto expected = fresh.track(stamped(static_cast<std::int64_t>(i), estimated_room().frame(i))),
                 result = restarted.track(stamped(static_cast<std::int64_t>(i), estimated_room().frame(i)));
      CHECK(result.status == expected.status);
      // The rows that were learned are the rig's, and stay: poses differ by less than they are known to.
      CHECK(result.current_from_reference->isApprox(*expected.current_from_reference, 1e-5));
      CHECK(result.counts.inliers == Approx(expected.counts.inliers).epsilon(0.01));
      CHECK(result.ambiguous_motion == expected.ambiguous_motion);
      CHECK(result.rig.displacement == 0);
      CHECK(result.warnings.size() == expected.warnings.size());
    }
  }
}
