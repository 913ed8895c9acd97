/// \file test_earlier_rigs.cpp  Keyframes that are kept for a loss, and the return to a place that they have seen.
#include "motion/earlier_rigs.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/view_change.hpp"
#include "saved_maps.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using odometry::EarlierRigs;
using odometry::KeyRig;

namespace {

/// A keyframe that looks to the right by `angle` [rad].
KeyRig turned(int frame, double angle) {
  auto frame_edges = std::make_shared<frontend::FrameEdges>();
  frame_edges->start(frame);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return KeyRig(frame_edges, {pose});
}

}  // namespace

TEST_CASE("earlier rigs: beyond the limit the one nearest to its successor leaves") {
  EarlierRigs earlier;
  const int most = static_cast<int>(odometry::kEarlierRigs);
  std::vector<KeyRig> rigs;
  double angle = 0;
  for (int i = 0; i <= most; ++i) {
    rigs.push_back(turned(i, angle));
    earlier.remember(rigs.back(), 0);
    angle += i == 4 ? 0.31 : 0.35 + 0.001 * i;  // within a turn and a half
  }
  for (int i = 0; i <= most; ++i)
    CHECK((earlier.find(rigs[static_cast<std::size_t>(i)].frame_edges()) == nullptr) == (i == 4));
  CHECK(earlier.nearest(Eigen::Isometry3d::Identity()).size() == odometry::kEarlierTrials);
}

TEST_CASE(
    "earlier rigs: a frame that sees an earlier place again stays in the segment, at the right pose; one that sees "
    "another scene is lost",
    "[device]") {
  const SyntheticSequence facade(saved_maps::small("facade", "drive", 103)), room(saved_maps::small("room", "loop", 9));
  const auto track = [&](StereoOdometry& odometry, const SyntheticSequence& scene, int frame, std::int64_t& stamp) {
    const Image left = scene.render(frame, Side::left).image, right = scene.render(frame, Side::right).image;
    return odometry.track({stamp += 50'000'000, left.view(), right.view()});
  };
  for (const auto& index : all_devices()) {
    INFO(index);
    Device device(index, kept_programs());
    StereoOdometry odometry(facade.rig(), device);
    std::int64_t stamp = 0;
    FrameResult last;
    for (int frame = 0; frame <= 60; frame += 2) last = track(odometry, facade, frame, stamp);
    REQUIRE(is_tracked(last.status));
    const FrameResult elsewhere = track(odometry, room, 0, stamp), back = track(odometry, facade, 3, stamp);
    CHECK_FALSE(is_tracked(elsewhere.status));
    REQUIRE(is_tracked(back.status));
    CHECK_THAT(back.message, Contains("located against frame"));
    CHECK(back.segment == 0);
    CHECK(back.reference_frame < 12);
    const Eigen::Isometry3d truth = facade.world_from_left(0).inverse() * facade.world_from_left(3),
                            error = truth.inverse() * *back.world_from_left;
    CHECK(error.translation().norm() < 0.01);
    CHECK(Eigen::AngleAxisd(error.linear()).angle() < 0.3 * kDegree);
    const FrameResult next = track(odometry, facade, 5, stamp);  // tracking goes on there
    CHECK(is_tracked(next.status));
    CHECK(next.segment == 0);
  }
}
