/// \file bench_edge_selection.cpp  Selection of the maxima of both images that become edges.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("edge_selection");

}  // namespace
