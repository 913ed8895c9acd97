#pragma once
/// \file bench_options.hpp  What `bench` and `compare` share.

namespace quadedge::cli {

/// Edges per image that a benchmark of the built-in sequence is made for: half of what the paper reports, whose edges
/// are half a pixel apart.
constexpr int kBenchEdges = 25'000;

}  // namespace quadedge::cli
