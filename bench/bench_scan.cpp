/// \file bench_scan.cpp  Exclusive prefix sums of one count per edge of a frame, by OpenCL events.
#include <benchmark/benchmark.h>

#include "opencl/context.hpp"
#include "opencl/variants.hpp"
#include "quadedge/device.hpp"
#include "stage_bench.hpp"
#include "stages/scan.hpp"

namespace {

using namespace quadedge;

void scan_counts(benchmark::State& state, const std::string& variant) {
  constexpr int kCounts = 50000;
  DeviceOptions profiling;
  profiling.profiling = true;
  Device device(stage_bench::device_choice(), profiling);
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

bool register_scan() {
  for (const auto& variant : opencl::all_variants()) {
    if (variant.stage != "scan") continue;
    benchmark::RegisterBenchmark(("scan/" + variant.name).c_str(),
                                 [name = variant.name](benchmark::State& state) { scan_counts(state, name); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}

[[maybe_unused]] const bool registered = register_scan();

}  // namespace
