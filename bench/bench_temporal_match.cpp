/// \file bench_temporal_match.cpp  The temporal cascade in one kernel; the variant "lists" runs other stages instead
/// and has no time here.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("temporal_match");

}  // namespace
