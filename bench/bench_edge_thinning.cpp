/// \file bench_edge_thinning.cpp  Thinning of the edges of both images.
#include "stage_bench.hpp"

namespace {

void thin(quadedge::Config& config, quadedge::StereoRig&) { config.edges.thinning = true; }

[[maybe_unused]] const bool registered = stage_bench::register_stage("edge_thinning", thin);

}  // namespace
