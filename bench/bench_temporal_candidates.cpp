/// \file bench_temporal_candidates.cpp  Temporal candidates as lists.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered =
    stage_bench::register_stage("temporal_candidates", stage_bench::match_by_lists);

}  // namespace
