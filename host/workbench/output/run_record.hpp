#pragma once
/// \file run_record.hpp  All results of one run, before they become files.

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "output/motion_errors.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/evaluation.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/self_test.hpp"

namespace quadedge::report {

/// Where the frames came from.
struct InputFacts {
  std::string path, format, name;
  int frames = 0;                          ///< 0 while unknown: of a pipe, or of a video that does not state it
  int width = 0, height = 0;               ///< of the left pinhole image [px]
  int dropped = 0;                         ///< pairs of a pipe that came faster than they were tracked, with --live
  std::vector<std::string> warnings = {};  ///< options that contradict the data
  std::vector<std::string> options = {};   ///< names and values in turn, as `quadedge run` takes them
};

/// Result of the self-test of the device.
struct DeviceTrust {
  std::string verdict;  ///< passed | failed: --trust was given | not needed: the reference
  SelfTestResult test;
};

/// The points that a run wrote.
struct PointFacts {
  std::size_t points = 0;
  std::size_t views = 0;    ///< keyframes that it was made from
  std::size_t dropped = 0;  ///< points dropped because memory was full
};

/// Latencies of a run [ms]; the first frame is separate. NaN without frames.
struct LatencySummary {
  double median = 0, p90 = 0, p99 = 0, max = 0, first = 0;
};

/// The closures of a run with --loops.
struct LoopFacts {
  std::size_t compared = 0, kept = 0;  ///< pairs of a frame and an earlier keyframe
  int segments = 0;                    ///< that remain
  std::size_t frames = 0;              ///< in the corrected trajectory
  std::size_t key_rigs = 0;            ///< kept
  double megabytes = 0;                ///< of the kept keyframes, on the host
  double total_ms = 0;                 ///< time of the map in all frames, which is not part of their latency
  LatencySummary latency;              ///< of the frames with the time of the map in it
};

/// One run.
struct RunRecord {
  std::string command;      ///< its command line
  std::string ended_early;  ///< why not all frames were tracked: a signal, an error; empty for a whole run
  InputFacts input;
  DeviceInfo device;
  DeviceTrust self_test;
  Config config;                                ///< effective
  std::map<std::string, std::string> variants;  ///< stage -> chosen kernel variant
  std::deque<FrameResult> frames;  ///< a deque, since a vector takes up to three times their memory while it grows
  double start_ms = 0;             ///< opening the device and building the pipeline, before the first frame
  double kernel_build_ms = 0;      ///< the part of it that builds kernels
  double host_peak_mb = 0, device_peak_mb = 0;
  /// Kernel times of the pass of `bench` with a profiling queue: one list per frame.
  std::vector<std::vector<StageTime>> kernel_times;
  std::optional<PointFacts> points;                           ///< only if requested
  std::optional<LoopFacts> loops;                             ///< only with --loops
  std::string truth_file;                                     ///< empty without ground truth
  std::optional<TrajectoryEvaluation> accuracy;               ///< only with ground truth
  std::vector<evaluation::StepConsistency> step_consistency;  ///< empty without ground truth

  int tracked() const {
    int count = 0;
    for (const auto& frame : frames) count += is_tracked(frame.status) ? 1 : 0;
    return count;
  }
};

LatencySummary latency_summary(const std::deque<FrameResult>& frames);
/// Of latencies in the order of the frames [ms].
LatencySummary latency_summary(std::vector<double> values);

/// Median and 90th percentile of each stage over all frames but the first, in order of first appearance.
struct StageSummary {
  std::string stage;
  double median = 0, p90 = 0;  ///< [ms]
};
std::vector<StageSummary> stage_summary(const std::vector<std::vector<StageTime>>& frames);

/// The host-side stage times of every frame.
std::vector<std::vector<StageTime>> stage_times(const std::deque<FrameResult>& frames);

/// Why frames were lost: "5 no consensus, 2 too few quads"; empty if there are none.
std::string lost_reasons(const std::deque<FrameResult>& frames);
/// The same from the number of frames of each status.
template <class Status>
std::string lost_reasons(const std::map<Status, int>& counts) {
  std::string text;
  for (const auto& [status, count] : counts) {
    std::string reason = to_string(status);  // lost_no_consensus
    if (reason.rfind("lost_", 0) != 0) continue;
    std::replace(reason.begin(), reason.end(), '_', ' ');
    text += (text.empty() ? "" : ", ") + std::to_string(count) + reason.substr(4);
  }
  return text;
}

/// The texts of warnings, separated by semicolons.
std::string joined(const std::vector<Warning>& warnings);

/// The segments of a run, and the tracked frames with an unknown motion between them: "3 segments: an unknown motion
/// lies between frames 33 and 35, ..."; empty for a single segment.
std::string segments_text(const std::deque<FrameResult>& frames);

/// Length of the estimated path, from each tracked frame to the next of the same segment [m].
double path_length_m(const std::deque<FrameResult>& frames);

/// Medians of the counts over all frames but the first, in the order of FrameCounts.
std::vector<std::pair<std::string, double>> count_medians(const std::deque<FrameResult>& frames);

/// Name and value of every count of a frame, in the order of FrameCounts.
std::vector<std::pair<std::string, int>> named_counts(const FrameCounts& counts);

}  // namespace quadedge::report
