/// \file bench_stages.cpp  Kernel time of every stage by OpenCL events, for each kernel variant, on the device of
/// QUADEDGE_DEVICE
/// ("auto" without it): bench_stages --benchmark_filter=edge_detection
#include <algorithm>
#include <benchmark/benchmark.h>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "benchmark/frontend_agreement.hpp"
#include "opencl/context.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"
#include "quadedge/synthetic.hpp"

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
    config.stereo.max_disparity = sequence.max_disparity();
    for (int i = 0; i < 2; ++i) {
      frames[i].stamp_ns = sequence.stamp_ns(i);
      frames[i].left = sequence.render(i, false).image;
      frames[i].right = sequence.render(i, true).image;
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

/// The second frame again and again with one variant of one stage; only that stage's kernels count.
void run_stage(benchmark::State& state, const std::string& stage, const std::string& variant,
               const std::vector<std::string>& booked_as) {
  Device device(device_choice(), "", true);
  Config config = scene().config;
  config.variants[stage] = variant;
  const auto frontend = frontend::make_frontend(scene().sequence.rig(), device, config);
  const auto warm = bench::run_frontend(*frontend, scene().frames[0], scene().frames[1], config);
  const auto search = bench::search_in_place(warm.previous, config.temporal, false);
  const auto& second = scene().frames[1];
  device.context()->take_profile();
  for (auto unused : state) {
    (void)unused;
    frontend->process({second.stamp_ns, second.left.view(), second.right.view()});
    frontend->match(*warm.first, search);
    double ms = 0;
    for (const auto& [name, time] : device.context()->take_profile()) {
      if (std::find(booked_as.begin(), booked_as.end(), name) != booked_as.end()) ms += time;
    }
    state.SetIterationTime(ms * 1e-3);
  }
  state.counters["edges"] = frontend->counts().edges_left + frontend->counts().edges_right;
}

void register_stages() {
  for (const auto& variant : opencl::all_variants()) {
    if (variant.stage == "undistortion") continue;  // the built-in sequence has no distortion
    const std::string stage = variant.stage, name = variant.name;
    std::vector<std::string> booked_as = {stage};
    if (stage == "candidate_filters") booked_as = {"stereo_filters", "temporal_filters"};
    if (stage == "scan") booked_as = {"edge_detection", "stereo_candidates", "temporal_candidates"};
    benchmark::RegisterBenchmark((stage + "/" + name).c_str(),
                                 [=](benchmark::State& state) { run_stage(state, stage, name, booked_as); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    register_stages();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return static_cast<int>(ExitCode::usage);
    benchmark::AddCustomContext("device", Device(device_choice()).info().name);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
  } catch (const Error& error) {
    std::cerr << "bench_stages: " << error.what() << "\n";
    return static_cast<int>(error.exit_code());
  }
  return 0;
}
