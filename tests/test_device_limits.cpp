/// \file test_device_limits.cpp  Simulated devices with tighter limits than the available ones.
#include "edges/memory_fit.hpp"
#include "frontends.hpp"

using namespace quadedge;
using namespace matching;
using Catch::Matchers::Contains;

namespace {

FrontendOutput run_limited(const RenderedScene& scene, const opencl::DeviceLimits& limits) {
  Device device = opencl::open_limited("0", kept_programs(), limits);
  return run_frontend(scene, device);
}

}  // namespace

TEST_CASE("limits: with small groups or without local memory other variants give the same bytes", "[opencl][device]") {
  const RenderedScene scene("room", 161, 97, 2);
  opencl::DeviceLimits as_gpu, small_groups, no_local;
  as_gpu.type = small_groups.type = no_local.type = "gpu";
  small_groups.group_items = 64;
  no_local.local_bytes = 0;
  const auto whole = run_limited(scene, as_gpu);
  REQUIRE(whole.current.size() > 100);
  CHECK(same_bytes(run_limited(scene, {}), whole));
  CHECK(same_bytes(run_limited(scene, small_groups), whole));
  CHECK(same_bytes(run_limited(scene, no_local), whole));

  Device device = opencl::open_limited("0", {}, small_groups);
  CHECK(opencl::choose_variant("edge_detection", *device.context(), {}).name == "tile64");
  CHECK(opencl::choose_variant("sift", *device.context(), {}).name == "cells");
  CHECK_THROWS_WITH(opencl::choose_variant("edge_detection", *device.context(), {{"edge_detection", "tile256"}}),
                    Contains("tile256 wants groups of 256") && Contains("up to 64"));
}

TEST_CASE("limits: a device that cannot store bytes is refused by name", "[opencl]") {
  opencl::DeviceLimits limits;
  limits.stores_bytes = false;
  CHECK_THROWS_WITH(opencl::open_limited("0", {}, limits), Contains("cl_khr_byte_addressable_store"));
  CHECK_THROWS_AS(opencl::open_limited("0", {}, limits), DeviceError);
}

TEST_CASE("limits: the budget is reduced to fit the memory, and the first frame warns about it", "[opencl]") {
  RenderedScene scene("room", 320, 200, 2);
  opencl::DeviceLimits limits;
  limits.memory_bytes = 60'000'000;
  scene.config.edges.budget = 0;
  Device device = opencl::open_limited("0", kept_programs(), limits);
  StereoOdometry odometry(scene.rig, device, scene.config);
  const auto first = odometry.track(scene.frame(0));
  REQUIRE(first.warnings.size() == 1);
  CHECK(first.warnings[0].kind == WarningKind::device_memory);
  CHECK_THAT(first.warnings[0].text, Contains("60 MB") && Contains("edges.budget (all edges) is reduced"));
  CHECK(first.counts.edges_left > 1000);
  CHECK(first.counts.edges_left < 5000);
  const auto second = odometry.track(scene.frame(1));
  CHECK(second.warnings.empty());
  CHECK(is_tracked(second.status));
  CHECK(odometry.device_bytes() < limits.memory_bytes);
}

TEST_CASE("limits: the paper's edges are reduced to fit the memory, too", "[opencl]") {
  RenderedScene scene("room", 320, 200, 1);
  scene.config = read_preset("paper");
  opencl::DeviceLimits limits;
  limits.memory_bytes = 80'000'000;
  Device device = opencl::open_limited("0", kept_programs(), limits);
  StereoOdometry odometry(scene.rig, device, scene.config);
  const auto first = odometry.track(scene.frame(0));
  REQUIRE(first.warnings.size() == 1);
  CHECK(first.warnings[0].kind == WarningKind::device_memory);
  CHECK_THAT(first.warnings[0].text, Contains("80 MB") && Contains("edges.max_edges (") && Contains("is reduced"));
  CHECK(first.diagnostics.overflow);
  CHECK(odometry.device_bytes() < limits.memory_bytes);
}

TEST_CASE("limits: memory_fit keeps what fits and refuses images that fill the memory", "[opencl]") {
  StereoRig rig;
  rig.left.width = rig.right.width = 1226;
  rig.left.height = rig.right.height = 370;
  Config config;
  CHECK(frontend::fit_memory(rig, config, 512'000'000).message.empty());
  config.edges.budget = 0;  // at most a fifth of the 453,620 pixels are edges
  CHECK(frontend::fit_memory(rig, config, 1'000'000'000).message.empty());
  const auto fit = frontend::fit_memory(rig, config, 512'000'000);
  // (0.75 * 512 MB - 16 MB - 160 B * 453,620) / 5000 B
  CHECK(fit.config.edges.budget == 59084);
  CHECK(fit.config.edges.max_edges == 118168);
  CHECK_THAT(fit.message, Contains("512 MB") && Contains("59084 edges per image"));
  config.edges.budget = 100000;
  CHECK_THAT(frontend::fit_memory(rig, config, 512'000'000).message, Contains("edges.budget (100000) is reduced"));
  // 0.75 * 512 MB - 16 MB - 160 B * 453,620 - 1.75 * 5000 B * 24,000 leave 85,420,800 B
  config.edges.budget = 24000;
  CHECK(frontend::fits_beside(rig, config, 85'420'800, 512'000'000));
  CHECK_FALSE(frontend::fits_beside(rig, config, 85'420'801, 512'000'000));
  rig.left.width = rig.left.height = 2000;
  CHECK_THROWS_WITH(frontend::fit_memory(rig, config, 512'000'000), Contains("2000x2000") && Contains("656 MB"));
}
