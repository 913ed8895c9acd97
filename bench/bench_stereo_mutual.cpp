/// \file bench_stereo_mutual.cpp  Stereo edges from mutually best candidates.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("stereo_mutual");

}  // namespace
