/// \file bench_refinement.cpp  Least squares on all inliers.
#include <benchmark/benchmark.h>
#include <optional>
#include <vector>

#include "bench_quads.hpp"
#include "pose/ransac.hpp"
#include "pose/refinement.hpp"

namespace {

using namespace quadedge;

void refinement(benchmark::State& state) {
  const auto& input = bench::quads_of(state.range(0));
  pose::ConsensusWorkspace search;
  const auto consensus = pose::find_consensus(input.quads, input.sequence.rig(), input.config.pose, input.config.seed,
                                              std::nullopt, search);
  pose::RefinementWorkspace workspace;
  std::vector<std::uint8_t> inlier;
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::refine(input.quads, input.sequence.rig(), input.config.pose,
                                          consensus.current_from_previous, 0, workspace, inlier));
  }
}
BENCHMARK(refinement)->Arg(4000)->Arg(40000)->Unit(benchmark::kMillisecond);

}  // namespace
