#include "common/layouts.hpp"
#include "frontends.hpp"
#include "motion/motion_search.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;
using namespace matching;

namespace {

const RenderedScene& kept_room() {
  static const RenderedScene scene("room", 320, 200, 2, 6);
  return scene;
}

}  // namespace

TEST_CASE("kept frame edges: at most half a megabyte, and patches and descriptors close to the original ones",
          "[device]") {
  Device device("reference");
  const auto frontend = frontend::make_frontend(kept_room().rig, device, kept_room().config);
  const auto frame_edges = frontend->process(kept_room().frame(0));
  const frontend::KeptFrameEdges kept = frontend::as_global(*frontend).keep();
  REQUIRE(kept.edges.size() > 500);
  CHECK(kept.edges.size() <= frontend::kKeptEdges);
  CHECK(static_cast<double>(kept.bytes()) / static_cast<double>(kept.edges.size()) * frontend::kKeptEdges < 500'000);
  const auto patches = reference::side_patches(kept_room().left[0].view(), kept.edges.left_x, kept.edges.left_y,
                                               kept.edges.left_direction, kept_room().config.patches);
  const frontend::KeptPatches unpacked = frontend::unpack_patches(kept);
  for (std::size_t k = 0; k < kept.edges.size(); ++k) {
    const auto* const before = patches.data() + k * kEdgePatchBytes;
    if (reference::inverse_norm(before, 0) <= 0) continue;
    INFO(k);
    CHECK(reference::patch_ncc(before, unpacked.left.data() + k * kEdgePatchBytes) > 0.97F);
  }
  const auto wide = frontend::unpack_wide(kept);
  for (std::size_t k = 0; k < kept.edges.size(); ++k) {
    double squares = 0;
    for (std::size_t i = 0; i < kWideBytes; ++i) squares += std::pow(wide[k * kWideBytes + i], 2);
    CHECK(std::sqrt(squares) == Approx(512).epsilon(0.05));
  }
}

TEST_CASE("kept frame edges: once restored they give the motion that the frame itself gives", "[device]") {
  for (const std::string& name : all_devices_and_reference()) {
    INFO(name);
    Device device(name, kept_programs());
    const auto frontend = frontend::make_frontend(kept_room().rig, device, kept_room().config);
    odometry::MotionSearch search(kept_room().config, frontend::as_global(*frontend), kept_room().rig);
    const auto base = frontend->process(kept_room().frame(0));
    const frontend::KeptFrameEdges kept = frontend::as_global(*frontend).keep();
    odometry::MotionQuery query;
    query.current = frontend->process(kept_room().frame(1));
    query.base = base;
    const auto whole = search.find(query);
    query.base = frontend::as_global(*frontend).restore(kept);
    CHECK(query.base->frame == 0);
    const auto restored = search.find(query);
    REQUIRE(whole->ok());
    REQUIRE(restored->ok());
    const Eigen::Isometry3d truth = kept_room().world_from_left[1].inverse() * kept_room().world_from_left[0];
    const Eigen::Isometry3d error = restored->motion.current_from_previous * truth.inverse();
    CHECK(error.translation().norm() < 0.01);
    CHECK(Eigen::AngleAxisd(error.linear()).angle() < 0.003);
    CHECK(restored->motion.inliers > static_cast<int>(kept.edges.size()) / 2);
    // A global search among given edges takes all of the restored frame's, whichever are named.
    GlobalSearch among;
    for (std::size_t i = 0; i < query.current->edges.size(); ++i)
      among.of_current.push_back(static_cast<std::int32_t>(i));
    TemporalMatches found;
    frontend::as_global(*frontend).match_globally(*query.base, *frontend->latest(), among, found);
    CHECK(found.size() > 100);
    CHECK(same_bytes(found, frontend::as_global(*frontend).match_globally(*query.base, 1000000)));
  }
}

TEST_CASE("kept frame edges: restoring one leaves the current frame and the frame numbers alone", "[device]") {
  for (const std::string& name : all_devices_and_reference()) {
    INFO(name);
    Device device(name, kept_programs());
    const auto frontend = frontend::make_frontend(kept_room().rig, device, kept_room().config);
    frontend->process(kept_room().frame(0));
    const frontend::KeptFrameEdges kept = frontend::as_global(*frontend).keep();
    const auto current = frontend->process(kept_room().frame(1));
    const StereoEdges before = current->edges;
    const auto first = frontend::as_global(*frontend).restore(kept),
               second = frontend::as_global(*frontend).restore(kept);
    CHECK(first != second);
    CHECK(same_bytes(current->edges, before));
    CHECK(same_bytes(first->edges, kept.edges));
    CHECK(frontend::as_global(*frontend).keep().frame == 1);
    CHECK(frontend->process(kept_room().frame(0))->frame == 2);
  }
}
