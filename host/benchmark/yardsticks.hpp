#pragma once
/// \file yardsticks.hpp  What OpenCV needs for two computations of known size.

#include <functional>

#include "benchmark/bench_record.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::bench {

/// Measures both yardsticks with `threads` threads on the recorded images of `frame`, `repetitions` times each, in
/// turn, after one to get warm. `progress` is told after each. OpenCV's number of threads is put back.
Yardsticks measure_yardsticks(const FramePrefetcher::Frame& frame, int threads, int repetitions,
                              const std::function<void(int done, int total)>& progress);

}  // namespace quadedge::bench
