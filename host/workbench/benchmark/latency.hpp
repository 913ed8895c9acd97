#pragma once
/// \file latency.hpp  Measures frames whose images are in host memory (doc/design.md section 5: latency and kernel
/// time are measured in separate passes).

#include <functional>
#include <vector>

#include "benchmark/bench_record.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::bench {

/// The input of a measurement.
struct Subject {
  const StereoRig& rig;
  const std::vector<FramePrefetcher::Frame>&
      frames;            ///< the first frame, record.warm_up warm-up frames, then the measured frames
  const Config& config;  ///< complete: with the largest disparity
  std::function<Device(bool profiling)> open_device;
  std::function<void(const char* pass, int done, int total)> progress;
};

/// Measures the time to open the device and build the pipeline, which is the program's first use of OpenCL, and records
/// device and variants. `complete` may adapt record.run.config to the device.
void measure_start(const StereoRig& rig, const std::function<Device()>& open_device,
                   const std::function<void(const Device&, Config&)>& complete, BenchRecord& record);

/// Measures the latency of every frame on a queue without profiling, memory and bytes moved.
void measure_latency(const Subject& subject, BenchRecord& record);

/// Measures the edge detection of one left image, `repetitions` times after two warm-up runs. Does nothing on the
/// reference device.
void measure_edge_detection(const Subject& subject, int repetitions, BenchRecord& record);

/// Measures the kernel times of every frame by OpenCL events, on a profiling queue, which slows the device down. Does
/// nothing on the reference device.
void measure_kernels(const Subject& subject, BenchRecord& record);

/// Measures two OpenCV computations with `threads` threads on the recorded images of `frame`, alternating,
/// `repetitions` times each after one warm-up. `progress` is called after each. Restores OpenCV's number of threads.
/// \param samples of the edge detector's grid, per pixel and axis
Yardsticks measure_yardsticks(const FramePrefetcher::Frame& frame, int samples, int threads, int repetitions,
                              const std::function<void(int done, int total)>& progress);

/// The value of edges.threshold for which the two images of the frame have about `wanted` edges each, by bisection
/// until the number is met within 1 % or the interval is shorter than 0.01. Returns the smallest threshold if the
/// images have fewer edges at every threshold. \throws UsageError on the reference device, which would take too long,
/// or if `wanted` exceeds edges.max_edges.
double threshold_for_edges(const FramePrefetcher::Frame& frame, int wanted, Device& device, const Config& config);

}  // namespace quadedge::bench
