/// \file bench_stereo_refinement.cpp  Photometric refinement of the stereo candidates.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_refinement");

}  // namespace
