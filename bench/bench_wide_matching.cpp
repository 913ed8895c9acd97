/// \file bench_wide_matching.cpp  Global matching of wide descriptors.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("wide_matching");

}  // namespace
