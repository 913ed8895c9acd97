#pragma once
/// \file bench_record.hpp  Everything that `quadedge bench` measures, and its JSON.

#include <optional>
#include <string>
#include <vector>

#include "opencl/context.hpp"
#include "report/run_record.hpp"

namespace quadedge::bench {

/// Version of the JSON; grows when a key changes its meaning.
constexpr int kBenchSchema = 3;

/// Two OpenCV computations of fixed size, measured in the same run: on shared machines, ratios to these drift less than
/// absolute times.
struct Yardsticks {
  std::vector<double> sift_both_ms;       ///< SIFT detectAndCompute on both images of a frame
  std::vector<double> sepfilter_nine_ms;  ///< nine sepFilter2D (CV_32F) on the grid of the edge detector
  int threads = 0;                        ///< that OpenCV used
};

/// The time of a frame as means over the measured frames of the profiling pass: the times of the stages, and the host's
/// remainder, in which the device has nothing to do. Together they make up the frame.
struct FrameShares {
  std::vector<opencl::StageProfile> stages;  ///< per frame; in order of first appearance
  double frame_ms = 0;                       ///< latency in that pass, increased by profiling
  double host_ms() const;
};

/// One benchmark. `run.frames` and `run.kernel_times` contain the first frame and the measured frames, without the
/// warm-up frames between them.
struct BenchRecord {
  report::RunRecord run;
  std::string command;           ///< as typed
  int warm_up = 0;               ///< frames between the first and the measured ones
  int threads = 0;               ///< processors of the device if it is a CPU, else of the host
  int edges_wanted = 0;          ///< per image, target of edges.threshold; 0: as configured
  std::vector<double> edges_ms;  ///< edge detection of one left image, from host memory until the device has finished
  double to_device_mb = 0, to_host_mb = 0;  ///< copied per measured frame
  double waits = 0;                         ///< for the device, per measured frame
  double launches = 0, writes = 0;          ///< kernels and copies to the device, per measured frame
  std::vector<double> processor_ms;         ///< of all threads, per measured frame
  std::vector<FrameShares> profiled;        ///< the measured frames of the profiling pass
  double frames_mb = 0;                     ///< recorded images in host memory, part of run.host_peak_mb
  std::optional<Yardsticks> yardsticks;

  FrameShares shares() const;  ///< mean of `profiled`; no stages where nothing was profiled
  double frame_ratio() const;  ///< median latency over the median of SIFT on both images; NaN without yardsticks
  double edges_ratio() const;  ///< median edge detection over the median of the nine filters; NaN without yardsticks
};

/// report.json's keys, and those of a benchmark.
std::string bench_json(const BenchRecord& record);

}  // namespace quadedge::bench
