#pragma once
/// \file roofline.hpp  An estimate of a frame's time on a GPU that was not run on: what is counted over the model's
/// ceilings, and the costs of launches and waits (the roofline model: Williams, Waterman, Patterson, Roofline: an
/// insightful visual performance model for multicore architectures, CACM 52(4), 2009).

#include <string>
#include <vector>

#include "benchmark/device_model.hpp"
#include "benchmark/frame_count.hpp"

namespace quadedge::bench {

/// Parts of a stage's time [ms], all estimated. A perfect kernel overlaps memory and arithmetic; nothing else overlaps.
struct StageEstimate {
  std::string stage;
  double memory_ms = 0, arithmetic_ms = 0, launches_ms = 0, waits_ms = 0, transfers_ms = 0;

  double total_ms() const;
  /// The largest part: "memory", "arithmetic", "launches", "waits" or "transfers".
  std::string bound() const;
};

/// A frame on a model.
struct FrameEstimate {
  DeviceModel model;
  std::vector<StageEstimate> stages;
  double host_ms = 0;  ///< measured, see FrameCount

  double device_ms() const;  ///< sum of the stages
  double frame_ms() const;   ///< with the host's part
  /// The largest parts of the frame, so many that the others together are within the model's goal, by falling time;
  /// the host's is called "host". Empty where the goal is reached or there is none.
  std::vector<std::string> in_the_way() const;
  std::vector<StageEstimate> by_time() const;  ///< the stages, the longest first
};

/// Time of a stage = max(bytes / memory, operations / arithmetic) + (launches + writes) * cost + waits * cost + bytes
/// copied / transfer bandwidth, every ceiling times its attainable share.
FrameEstimate estimate_frame(const DeviceModel& model, const FrameCount& count);

/// Everything as JSON: what was counted on `device`, and an estimate per model, each marked as one.
std::string estimates_json(const DeviceInfo& device, const Config& config, const FrameCount& count,
                           const std::vector<FrameEstimate>& estimates, const std::string& command);

}  // namespace quadedge::bench
