/// \file bench_stereo_clusters.cpp  Clustering of refined candidates.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_clusters");

}  // namespace
