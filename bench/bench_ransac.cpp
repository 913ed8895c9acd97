/// \file bench_ransac.cpp  The complete RANSAC search.
#include <benchmark/benchmark.h>
#include <optional>

#include "bench_quads.hpp"
#include "pose/ransac.hpp"

namespace {

using namespace quadedge;

void ransac(benchmark::State& state) {
  const auto& input = bench::quads_of(state.range(0));
  pose::ConsensusWorkspace workspace;
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::find_consensus(input.quads, input.sequence.rig(), input.config.pose,
                                                  input.config.seed, std::nullopt, workspace));
  }
}
BENCHMARK(ransac)->Arg(4000)->Arg(40000)->Unit(benchmark::kMillisecond);

}  // namespace
