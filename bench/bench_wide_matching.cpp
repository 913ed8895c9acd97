/// \file bench_wide_matching.cpp  Wide descriptors matched anywhere in the image.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("wide_matching");

}  // namespace
