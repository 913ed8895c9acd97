/// \file bench_temporal_quads.cpp  Agreement and selection on candidate lists.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("temporal_quads", stage_bench::match_by_lists);

}  // namespace
