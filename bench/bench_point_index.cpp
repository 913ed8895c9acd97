/// \file bench_point_index.cpp  Sorting of the stereo edges of both sides by cells.
#include "stage_bench.hpp"

namespace {

[[maybe_unused]] const bool registered = stage_bench::register_stage("point_index");

}  // namespace
