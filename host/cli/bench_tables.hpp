#pragma once
/// \file bench_tables.hpp  The tables of `bench` on stdout.

#include "benchmark/bench_comparison.hpp"
#include "benchmark/bench_record.hpp"

namespace quadedge::cli {

/// What was measured.
void print_benchmark(const bench::BenchRecord& record);

/// Every figure of both results, what else differs, and the verdict.
void print_comparison(const bench::BenchComparison& comparison, double noise_percent);

}  // namespace quadedge::cli
