#include "testing.hpp"

using namespace quadedge;

namespace {

/// Two frames of the room, with few enough edges for a simulator of OpenCL devices.
std::vector<FrameResult> track_small_room(const std::string& device_name) {
  auto options = rendering(96, 64, 55, 2, 4);
  options.baseline = 0.15;
  const SyntheticSequence sequence(options);
  Config config;
  config.edges.threshold = 10;
  Device device(device_name, kept_programs());
  StereoOdometry odometry(sequence.rig(), device, config);
  std::vector<FrameResult> results;
  for (int i = 0; i < sequence.frames(); ++i) results.push_back(odometry.track(sequence.pair(i).view()));
  return results;
}

}  // namespace

TEST_CASE("pipeline: every device finds the reference's edges, quads and poses in a small sequence",
          "[device][oclgrind]") {
  const auto expected = track_small_room("reference");
  REQUIRE(expected.back().status == FrameStatus::tracked);
  for (const auto& name : all_devices()) {
    const auto found = track_small_room(name);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      INFO("device " << name << ", frame " << i);
      CHECK(found[i].status == expected[i].status);
      // Edges within rounding of a threshold may differ, and so may everything that depends on them.
      const auto near = [](int count) { return Approx(count).epsilon(0.02).margin(2); };
      CHECK(found[i].counts.edges_left == near(expected[i].counts.edges_left));
      CHECK(found[i].counts.edges_right == near(expected[i].counts.edges_right));
      CHECK(found[i].counts.stereo_edges == near(expected[i].counts.stereo_edges));
      CHECK(found[i].counts.quads == near(expected[i].counts.quads));
      const Eigen::Isometry3d difference =
          found[i].world_from_left.value().inverse() * expected[i].world_from_left.value();
      CHECK(difference.translation().norm() < 1e-3);
      CHECK(Eigen::AngleAxisd(difference.linear()).angle() < 1e-3);
    }
  }
}
