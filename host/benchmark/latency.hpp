#pragma once
/// \file latency.hpp  Measures frames whose images lie in host memory (doc/design.md section 5: two kinds of time,
/// never mixed).

#include <functional>
#include <vector>

#include "benchmark/bench_record.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::bench {

/// What is measured.
struct Subject {
  const StereoRig& rig;
  const std::vector<FramePrefetcher::Frame>&
      frames;            ///< the first one, record.warm_up to get warm, then the measured ones
  const Config& config;  ///< complete: with the largest disparity
  std::function<Device(bool profiling)> open_device;
  std::function<void(const char* pass, int done, int total)> progress;
};

/// Time to open the device and to build the pipeline, the program's first use of OpenCL; and what device and variants
/// that are. `complete` may still change record.run.config to suit the device.
void measure_start(const StereoRig& rig, const std::function<Device()>& open_device,
                   const std::function<void(const Device&, Config&)>& complete, BenchRecord& record);

/// Latency of every frame on a plain queue, memory, bytes moved.
void measure_latency(const Subject& subject, BenchRecord& record);

/// Edge detection of one left image alone, `repetitions` times after two to get warm. Does nothing on the reference
/// device.
void measure_edge_detection(const Subject& subject, int repetitions, BenchRecord& record);

/// Kernel times of every frame by OpenCL events, on a profiling queue, which slows the device down. Does nothing on the
/// reference device.
void measure_kernels(const Subject& subject, BenchRecord& record);

/// The value of edges.threshold with which the two images of the frame have about `wanted` edges each: bisection, until
/// it is met within 1 % or the interval is shorter than 0.01. Images with fewer edges at every threshold give the
/// smallest one. \throws UsageError on the reference device for the sake of time, or for more than edges.max_edges
/// wanted.
double threshold_for_edges(const FramePrefetcher::Frame& frame, int wanted, Device& device, const Config& config);

}  // namespace quadedge::bench
