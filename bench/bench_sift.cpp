/// \file bench_sift.cpp  SIFT descriptors of the edges of both images.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("sift", stage_bench::match_with_sift);

}  // namespace
