/// \file bench_candidate_filters.cpp  NCC and nearly best over the candidates of a frame, in stereo and in time.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("candidate_filters", stage_bench::match_by_lists);

}  // namespace
