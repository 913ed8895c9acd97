#pragma once
/// \file run_cost.hpp  Time and memory that this process takes.

#include <chrono>
#include <sys/resource.h>

namespace quadedge {

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Largest resident size of this process so far.
inline double host_peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

}  // namespace quadedge
