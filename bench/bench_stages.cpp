/// \file bench_stages.cpp  Kernel times of every variant of every stage, by OpenCL events, on the device
/// QUADEDGE_DEVICE ("auto" if unset): bench_stages --benchmark_filter=patches
#include <benchmark/benchmark.h>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "benchmark/frontend_agreement.hpp"
#include "opencl/buffer.hpp"
#include "opencl/context.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"
#include "quadedge/synthetic.hpp"
#include "stages/scan.hpp"

namespace {

using namespace quadedge;

/// Two frames of the built-in sequence at the paper's size.
struct Scene {
  SyntheticSequence sequence{[] {
    SyntheticOptions options;
    options.frames = 2;
    return options;
  }()};
  Config config;
  FramePrefetcher::Frame frames[2];
  Scene() {
    config.stereo.max_disparity = sequence.rig().max_disparity;
    for (int i = 0; i < 2; ++i) {
      frames[i].stamp_ns = sequence.stamp_ns(i);
      frames[i].left = sequence.render(i, Side::left).image;
      frames[i].right = sequence.render(i, Side::right).image;
    }
  }
};
const Scene& scene() {
  static const Scene made;
  return made;
}

std::string device_choice() {
  const char* chosen = std::getenv("QUADEDGE_DEVICE");
  return chosen == nullptr ? "auto" : chosen;
}

Device profiled_device() {
  DeviceOptions profiling;
  profiling.profiling = true;
  return Device(device_choice(), profiling);
}

/// Moves every pixel by a fraction.
UndistortionTable shifting_table(const PinholeCamera& camera) {
  UndistortionTable table{camera.width, camera.height, {}, {}};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      table.source_x.push_back(static_cast<float>(x) + 0.25f);
      table.source_y.push_back(static_cast<float>(y) + 0.25f);
    }
  }
  return table;
}

/// Changes configuration and rig so that the built-in sequence runs a stage that it would skip.
void enable(const std::string& stage, Config& config, StereoRig& rig) {
  if (stage == "candidate_filters" || stage == "temporal_candidates" || stage == "temporal_quads")
    config.variants["temporal_match"] = "lists";
  if (stage == "sift") config.stereo.sift_max = 500;  // as in the paper
  if (stage != "undistortion") return;
  rig.left_undistortion = shifting_table(rig.left);
  rig.right_undistortion = shifting_table(rig.right);
}

/// Each repetition processes the second frame and matches it with the first one, guided and globally; only the kernels
/// of the stage count.
void run_stage(benchmark::State& state, const std::string& stage, const std::string& variant) {
  Device device = profiled_device();
  Config config = scene().config;
  StereoRig rig = scene().sequence.rig();
  enable(stage, config, rig);
  if (!variant.empty()) config.variants[stage] = variant;
  const auto frontend = frontend::make_frontend(rig, device, config);
  const auto warm = bench::run_frontend(*frontend, scene().frames[0], scene().frames[1], config);
  const auto search = bench::search_without_motion(warm.previous, config.temporal, false);
  const auto& second = scene().frames[1];
  TemporalMatches matches;
  device.context()->take_profile();
  for (auto unused : state) {
    (void)unused;
    frontend->process(second.view());
    frontend->match(*warm.first, search, matches);
    frontend->match_globally(*warm.first, matches);
    double ms = 0;
    for (const auto& row : device.context()->take_profile()) {
      if (row.stage == stage) ms += row.kernel_ms;
    }
    if (ms == 0) return state.SkipWithError("this variant never runs the stage");
    state.SetIterationTime(ms * 1e-3);
  }
  state.counters["edges"] = frontend->counts().edges_left + frontend->counts().edges_right;
}

/// Exclusive prefix sums of one count per edge of a frame.
void run_scan(benchmark::State& state, const std::string& variant) {
  constexpr int kCounts = 50000;
  Device device = profiled_device();
  auto& context = *device.context();
  stages::Scan scan(context, {{"scan", variant}});
  opencl::Buffer<cl_int> counts, first, total;
  counts.write(context, std::vector<cl_int>(kCounts, 8));
  context.begin_stage("scan");
  for (auto unused : state) {
    (void)unused;
    scan.run(counts, kCounts, 8 * kCounts, first, total);
    double ms = 0;
    for (const auto& row : context.take_profile()) ms += row.kernel_ms;
    state.SetIterationTime(ms * 1e-3);
  }
}

void add(const std::string& stage, const std::string& variant) {
  const auto run = [=](benchmark::State& state) {
    stage == "scan" ? run_scan(state, variant) : run_stage(state, stage, variant);
  };
  benchmark::RegisterBenchmark((stage + (variant.empty() ? "" : "/" + variant)).c_str(), run)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return static_cast<int>(ExitCode::usage);
    for (const auto& variant : opencl::all_variants()) add(variant.stage, variant.name);
    add("edge_selection", "");  // has no variants
    benchmark::AddCustomContext("device", Device(device_choice()).info().name);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
  } catch (const Error& error) {
    std::cerr << "bench_stages: " << error.what() << "\n";
    return static_cast<int>(error.exit_code());
  }
  return 0;
}
