#pragma once
/// \file bench_options.hpp  What `bench` and `compare` share.

namespace quadedge::cli {

/// Edges per image that a benchmark of the built-in sequence is made for, as many as the paper reports.
constexpr int kBenchEdges = 25'000;

}  // namespace quadedge::cli
