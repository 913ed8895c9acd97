#pragma once
/// \file bench_record.hpp  Everything that `quadedge bench` measures, and its JSON.

#include <optional>
#include <string>
#include <vector>

#include "opencl/context.hpp"
#include "report/run_record.hpp"

namespace quadedge::bench {

/// Version of the JSON; grows when a key changes its meaning.
constexpr int kBenchSchema = 2;

/// Two OpenCV computations of known size, measured in the same run: absolute times drift on shared machines, ratios to
/// these less.
struct Yardsticks {
  std::vector<double> sift_both_ms;       ///< SIFT detectAndCompute on both images of a frame
  std::vector<double> sepfilter_nine_ms;  ///< nine sepFilter2D of 35 taps (CV_32F) on one image of doubled size
  int threads = 0;                        ///< that OpenCV used
};

/// Where the time of a frame goes, as means over the measured frames of the profiling pass: the stages' times, and the
/// rest, in which the device has nothing to do because the host computes. Together they are the frame.
struct FrameShares {
  std::vector<opencl::StageProfile> stages;  ///< per frame; in order of first appearance
  double frame_ms = 0;                       ///< latency in that pass, which profiling slows down
  double host_ms() const;
};

/// One benchmark. `run.frames` holds the first frame, then the measured ones; those of the warm-up between them are
/// left out, and likewise in `run.kernel_times`.
struct BenchRecord {
  report::RunRecord run;
  std::string command;           ///< as it was typed
  int warm_up = 0;               ///< frames between the first and the measured ones
  int threads = 0;               ///< processors that the device uses where it is a CPU, else those of the host
  int edges_wanted = 0;          ///< per image, what edges.threshold was chosen for; 0: it was left as configured
  std::vector<double> edges_ms;  ///< edge detection of one left image: from host memory until the device is done
  double to_device_mb = 0, to_host_mb = 0;  ///< copied per measured frame
  double waits = 0;                         ///< for the device, per measured frame
  double launches = 0, writes = 0;          ///< kernels and copies to the device, per measured frame
  std::vector<double> processor_ms;         ///< of all threads, per measured frame
  std::vector<FrameShares> profiled;        ///< the measured frames of the profiling pass
  double frames_mb = 0;                     ///< the recorded images kept in host memory, part of run.host_peak_mb
  std::optional<Yardsticks> yardsticks;

  FrameShares shares() const;  ///< mean of `profiled`; no stages where nothing was profiled
  double frame_ratio() const;  ///< median latency over the median of SIFT on both images; NaN without yardsticks
  double edges_ratio() const;  ///< median edge detection over the median of the nine filters; NaN without yardsticks
};

/// report.json's keys, and those of a benchmark.
std::string bench_json(const BenchRecord& record);

}  // namespace quadedge::bench
