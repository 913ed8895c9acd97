/// \file bench_wide_description.cpp  Wide descriptors of a subset of the stereo edges.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("wide_description");

}  // namespace
