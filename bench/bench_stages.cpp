/// \file bench_stages.cpp  Kernel times of all stages (bench_STAGE.cpp) on the device QUADEDGE_DEVICE ("auto" if
/// unset): bench_stages --benchmark_filter=patches
#include <benchmark/benchmark.h>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "benchmark/frontend_agreement.hpp"
#include "opencl/context.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"
#include "quadedge/synthetic.hpp"
#include "stage_bench.hpp"

namespace stage_bench {
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

/// `variant`: empty for the default.
void run_stage(benchmark::State& state, const std::string& stage, const std::string& variant, const Prepare& prepare) {
  DeviceOptions profiling;
  profiling.profiling = true;
  Device device(stage_bench::device_choice(), profiling);
  Config config = scene().config;
  StereoRig rig = scene().sequence.rig();
  if (prepare) prepare(config, rig);
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

}  // namespace

std::string device_choice() {
  const char* chosen = std::getenv("QUADEDGE_DEVICE");
  return chosen == nullptr ? "auto" : chosen;
}

bool register_stage(const std::string& stage, const Prepare& prepare) {
  std::vector<std::string> variants;
  for (const auto& variant : opencl::all_variants()) {
    if (variant.stage == stage) variants.push_back(variant.name);
  }
  if (variants.empty()) variants.emplace_back();
  for (const auto& variant : variants) {
    const std::string name = variant.empty() ? stage : stage + "/" + variant;
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) { run_stage(state, stage, variant, prepare); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}

void match_by_lists(Config& config, StereoRig&) { config.variants["temporal_match"] = "lists"; }
void match_with_sift(Config& config, StereoRig&) { config.stereo.sift_max = 500; }

}  // namespace stage_bench

int main(int argc, char** argv) {
  try {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return static_cast<int>(quadedge::ExitCode::usage);
    benchmark::AddCustomContext("device", quadedge::Device(stage_bench::device_choice()).info().name);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
  } catch (const quadedge::Error& error) {
    std::cerr << "bench_stages: " << error.what() << "\n";
    return static_cast<int>(error.exit_code());
  }
  return 0;
}
