#pragma once
/// \file bench_record.hpp  Everything that `quadedge bench` measures, its JSON, and two such results, figure by
/// figure.

#include <optional>
#include <string>
#include <vector>

#include "device/context.hpp"
#include "output/run_record.hpp"

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

/// Exit code of a comparison that finds a regression; follows the codes of ExitCode.
constexpr int kRegressionExitCode = 6;

/// One figure of both results. Smaller is better.
struct ComparedFigure {
  std::string name;  ///< with its unit
  double before = 0, after = 0;
  double change_percent = 0;  ///< of `after`; times are corrected for the machine's drift; NaN if `before` is zero
  bool judged = false;        ///< false for start-up times and stages below 5 % of the frame, which are only shown
  bool worse = false;         ///< judged, and worse by more than the noise band
};

/// All figures of two results.
struct BenchComparison {
  std::vector<ComparedFigure> figures;
  std::vector<std::string> notes;  ///< other differences: commit, configuration, variants, command
  double drift = 1;  ///< slowdown of the machine for the newer result, from both SIFT baselines; 1 if one is missing
  bool has_yardsticks = false;  ///< in both results; otherwise times are not corrected for the machine's drift
  bool regressed() const;
};

/// Compares two results. `noise_percent`: a judged figure up to this much larger counts as equal. Any newly lost frame
/// is a regression. \throws DataError, naming the file, if a file cannot be read, is not a result of `quadedge bench`,
/// or was measured on another device or input.
BenchComparison compare_benchmarks(const std::string& old_file, const std::string& new_file, double noise_percent);

}  // namespace quadedge::bench
