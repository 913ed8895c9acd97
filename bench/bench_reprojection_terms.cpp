/// \file bench_reprojection_terms.cpp  Normal equations of many quads, as one step of the refinement needs them.
#include <benchmark/benchmark.h>
#include <numeric>
#include <vector>

#include "bench_quads.hpp"
#include "pose/reprojection_terms.hpp"

namespace {

using namespace quadedge;

/// Terms of all quads.
pose::ReprojectionTerms terms_of(const bench::BenchQuads& input) {
  std::vector<std::int32_t> rows(input.quads.size());
  std::iota(rows.begin(), rows.end(), 0);
  pose::ReprojectionTerms terms;
  terms.assign(input.quads, rows, input.sequence.rig().left, pose::NoiseModel(input.config.pose));
  return terms;
}

void normal_by_pose(benchmark::State& state) {
  const auto& input = bench::quads_of(state.range(0));
  auto terms = terms_of(input);
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::normal_by_pose(terms, input.motion, 0, {}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input.quads.size()));
}
BENCHMARK(normal_by_pose)->Arg(1000)->Arg(40000);

void normal_by_pose_and_offset(benchmark::State& state) {
  const auto& input = bench::quads_of(state.range(0));
  auto terms = terms_of(input);
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::normal_by_pose_and_offset(terms, input.motion, 0.1, {}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input.quads.size()));
}
BENCHMARK(normal_by_pose_and_offset)->Arg(1000)->Arg(40000);

}  // namespace
