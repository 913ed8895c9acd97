/// \file bench_candidate_filters.cpp  NCC and nearly-best filters on the stereo and temporal candidates of a frame.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("candidate_filters", stage_bench::match_by_lists);

}  // namespace
