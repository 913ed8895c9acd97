#pragma once
/// \file timing.hpp  Time and memory used by this process, and the stages of a frame that the host times.

#include <array>
#include <chrono>
#include <sys/resource.h>

namespace quadedge {

constexpr const char* kStereoStage = "stereo";
constexpr const char* kTemporalStage = "temporal";
constexpr const char* kPoseStage = "pose";

/// In their order. A frame that is lost early does not reach all of them.
constexpr std::array<const char*, 3> kHostStages = {kStereoStage, kTemporalStage, kPoseStage};

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Processor time of all threads of this process so far [ms].
inline double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto milliseconds = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
}

/// Peak resident memory of this process so far [MiB].
inline double host_peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

}  // namespace quadedge
