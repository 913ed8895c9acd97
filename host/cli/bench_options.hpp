#pragma once
/// \file bench_options.hpp  What `bench` and `compare` share.

#include <string>

namespace quadedge::cli {

/// Edges per image that a benchmark of the built-in sequence is made for, as many as the paper reports.
constexpr int kBenchEdges = 50'000;

/// The command line of this process as it was typed, the program itself named quadedge.
std::string command_line();

}  // namespace quadedge::cli
