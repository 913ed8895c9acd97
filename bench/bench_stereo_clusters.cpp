/// \file bench_stereo_clusters.cpp  Refined candidates to clusters.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_clusters");

}  // namespace
