#pragma once
/// \file frame_count.hpp  What a tracked frame asks of a GPU, counted stage by stage without one.

#include <map>
#include <string>
#include <vector>

#include "benchmark/latency.hpp"
#include "benchmark/stage_work.hpp"

namespace quadedge::bench {

/// One stage, means per tracked frame.
struct StageCount {
  std::string stage;
  StageWork work;                     ///< the least of all its runs
  double launches = 0, writes = 0;    ///< kernels, and copies to the device
  double waits = 0;                   ///< of the host for the stage's results
  double to_device = 0, to_host = 0;  ///< bytes copied
};

/// One frame.
struct FrameCount {
  std::vector<StageCount> stages;  ///< that take part, in the order of the variants; those without any come after them
  std::map<std::string, std::string> variants;  ///< that were counted: those of GPUs, but for what was asked for
  int frames = 0, tracked = 0;                  ///< that were counted, and of them the tracked ones
  double left_edges = 0, right_edges = 0;       ///< of the last frame
  double host_ms = 0;  ///< median, measured here: the device has nothing to do because the host computes
};

/// Tracks the subject's frames with the kernel forms of GPUs and counts all but the first and `warm_up` ones after it,
/// then again with the device's own forms for the host's part, which is the same in both. The least work is that of the
/// last two frames, times how often a tracked frame launches the stage compared with one run of what least_work() is
/// about. \throws UsageError for fewer than two counted frames, DeviceError where the device cannot run a form.
FrameCount count_stages(const Subject& subject, int warm_up);

}  // namespace quadedge::bench
