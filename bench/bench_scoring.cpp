/// \file bench_scoring.cpp  The cost of one motion for many quads.
#include <benchmark/benchmark.h>

#include "bench_quads.hpp"
#include "pose/scoring.hpp"

namespace {

using namespace quadedge;

void scoring(benchmark::State& state) {
  const auto& input = bench::quads_of(state.range(0));
  const pose::LaterCameras cameras(input.sequence.rig(), input.motion);
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::truncated_cost(input.quads.scoring, cameras, input.config.pose.inlier_distance));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input.quads.size()));
}
BENCHMARK(scoring)->Arg(512)->Arg(4000)->Arg(40000);

}  // namespace
