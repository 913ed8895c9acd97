/// \file bench_temporal_match.cpp  The temporal cascade in one kernel; with the variant "lists" it has no time of its
/// own.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("temporal_match");

}  // namespace
