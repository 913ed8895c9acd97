/// \file bench_patches.cpp  Side patches of the edges of both images and of the stereo edges.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("patches");

}  // namespace
