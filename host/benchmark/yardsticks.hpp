#pragma once
/// \file yardsticks.hpp  The time OpenCV takes for two computations of fixed size, a baseline for other times.

#include <functional>

#include "benchmark/bench_record.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::bench {

/// Measures both baselines with `threads` threads on the recorded images of `frame`, alternating, `repetitions` times
/// each after one warm-up. `progress` is called after each. Restores OpenCV's number of threads.
Yardsticks measure_yardsticks(const FramePrefetcher::Frame& frame, int threads, int repetitions,
                              const std::function<void(int done, int total)>& progress);

}  // namespace quadedge::bench
