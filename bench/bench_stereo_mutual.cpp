/// \file bench_stereo_mutual.cpp  The edges' choices to stereo edges.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_mutual");

}  // namespace
