/// \file bench_temporal_quads.cpp  Agreement and choice over candidate lists.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("temporal_quads", stage_bench::match_by_lists);

}  // namespace
