/// \file bench_edge_threshold.cpp  The threshold of a frame's edges.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("edge_threshold");

}  // namespace
