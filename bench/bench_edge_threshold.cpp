/// \file bench_edge_threshold.cpp  The edge threshold of a frame.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("edge_threshold");

}  // namespace
