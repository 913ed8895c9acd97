/// \file bench_stereo_relaxation.cpp  Votes of neighbouring edges on the candidates.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_relaxation");

}  // namespace
