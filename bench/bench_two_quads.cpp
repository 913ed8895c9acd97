/// \file bench_two_quads.cpp  The two-quad solver (Proposition 2).
#include <benchmark/benchmark.h>

#include "bench_quads.hpp"
#include "pose/constraints.hpp"
#include "pose/two_quads.hpp"

namespace {

using namespace quadedge;

void two_quads(benchmark::State& state) {
  const auto& input = bench::quads_of(2000);
  const double max_cosine = pose::ConstraintLimits(input.config.pose).max_cosine;
  std::size_t i = 0;
  for (auto unused : state) {
    (void)unused;
    const std::size_t a = i % input.quads.size(), b = (i * 7 + 1) % input.quads.size();
    benchmark::DoNotOptimize(pose::solve_two_quads(
        {input.quads.previous[a].oriented_point(), input.quads.previous[b].oriented_point()},
        {input.quads.current[a].oriented_point(), input.quads.current[b].oriented_point()}, max_cosine));
    ++i;
  }
}
BENCHMARK(two_quads);

}  // namespace
