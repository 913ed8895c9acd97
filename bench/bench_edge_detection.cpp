/// \file bench_edge_detection.cpp  Third-order edges of both images.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("edge_detection");

}  // namespace
