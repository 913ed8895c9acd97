/// \file bench_stereo_candidates.cpp  Candidates on the epipolar lines.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_candidates");

}  // namespace
