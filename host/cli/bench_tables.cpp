#include "cli/bench_tables.hpp"

#include <cmath>
#include <cstdio>

#include "cli/console.hpp"
#include "report/statistics.hpp"

namespace quadedge::cli {
namespace {

/// The host's phases, which follow one another.
void print_phases(const std::vector<report::StageSummary>& phases, double frame_ms) {
  std::printf("\nphases by the host's clock, median\n");
  for (const auto& phase : phases) {
    std::printf("  %-20s %9.2f ms %5.1f %%   p90 %9.2f\n", phase.stage.c_str(), phase.median,
                100 * phase.median / frame_ms, phase.p90);
  }
}

/// Where the time of a frame goes, stage by stage.
void print_shares(const bench::FrameShares& shares) {
  if (shares.stages.empty()) return;
  std::printf("\nstages of a frame by OpenCL events, in a separate pass (%.2f ms per frame), mean [ms]\n",
              shares.frame_ms);
  std::printf("  %-20s %9s %7s %9s %9s %9s %9s\n", "", "wall", "share", "kernels", "transfers", "starting", "launches");
  opencl::StageProfile sum;
  for (const auto& stage : shares.stages) {
    std::printf("  %-20s %9.2f %5.1f %% %9.2f %9.2f %9.2f %9.1f\n", stage.stage.c_str(), stage.wall_ms(),
                100 * stage.wall_ms() / shares.frame_ms, stage.kernel_ms, stage.transfer_ms, stage.queue_ms,
                stage.launches);
    sum.kernel_ms += stage.kernel_ms;
    sum.transfer_ms += stage.transfer_ms;
    sum.queue_ms += stage.queue_ms;
    sum.launches += stage.launches;
  }
  std::printf("  %-20s %9.2f %5.1f %%   the device waits for what the host computes, poses above all\n", "host",
              shares.host_ms(), 100 * shares.host_ms() / shares.frame_ms);
  std::printf("  %-20s %9.2f %5.1f %% %9.2f %9.2f %9.2f %9.1f\n", "frame", shares.frame_ms, 100.0, sum.kernel_ms,
              sum.transfer_ms, sum.queue_ms, sum.launches);
}

double count(const report::RunRecord& run, const std::string& name) {
  for (const auto& [key, value] : report::count_medians(run.frames)) {
    if (key == name) return value;
  }
  return NAN;
}

}  // namespace

void print_benchmark(const bench::BenchRecord& record) {
  const auto& run = record.run;
  std::printf("%s, %dx%d, on %s\n", run.input.name.c_str(), run.input.width, run.input.height, run.device.name.c_str());
  std::printf("measured frames: %d, after the first and %d for warm-up; tracked: %d of %zu\n",
              static_cast<int>(run.frames.size()) - 1, record.warm_up, run.tracked(), run.frames.size());
  std::printf("edge threshold %.4g%s: %.0f and %.0f edges per image, %.0f stereo edges, %.0f quads\n",
              run.frames.back().result.diagnostics.edge_threshold, record.edges_wanted > 0 ? " (chosen)" : "",
              count(run, "edges_left"), count(run, "edges_right"), count(run, "stereo_edges"), count(run, "quads"));
  const auto latency = report::latency_summary(run.frames);
  std::printf("\nframe             median %.2f ms, p90 %.2f, p99 %.2f, max %.2f; first %.2f\n", latency.median,
              latency.p90, latency.p99, latency.max, latency.first);
  const double processor = report::median(record.processor_ms);
  std::printf("processor time    median %.2f ms per frame, %.2f of the wall time\n", processor,
              processor / latency.median);
  if (!record.edges_ms.empty()) {
    std::printf("edge detection    median %.2f ms, p90 %.2f; one image\n", report::median(record.edges_ms),
                report::percentile(record.edges_ms, 0.9));
  }
  std::printf("start-up          %.0f ms\n", run.start_ms);
  std::printf("kernel build      %.0f ms of it, without what the driver generates where a kernel runs first\n",
              run.kernel_build_ms);
  std::printf("memory            host peak %.0f MB (%.0f MB of it recorded images), device peak %.0f MB\n",
              run.host_peak_mb, record.frames_mb, run.device_peak_mb);
  std::printf("queue per frame   %.1f launches, %.1f writes of %.2f MB, %.2f MB read back, %.1f waits\n",
              record.launches, record.writes, record.to_device_mb, record.to_host_mb, record.waits);
  print_phases(report::stage_summary(report::stage_times(run.frames)), latency.median);
  print_shares(record.shares());
  if (!record.yardsticks) return;
  std::printf("\nyardsticks with OpenCV, %d threads\n", record.yardsticks->threads);
  std::printf("  S: SIFT on both images       %9.2f ms   frame / S           %.3f\n",
              report::median(record.yardsticks->sift_both_ms), record.frame_ratio());
  std::printf("  N: nine sepFilter2D          %9.2f ms   edge detection / N  %.3f\n",
              report::median(record.yardsticks->sepfilter_nine_ms), record.edges_ratio());
}

void print_comparison(const bench::BenchComparison& comparison, double noise_percent) {
  std::printf("%-34s %10s %10s %9s\n", "", "before", "after", "change");
  for (const auto& figure : comparison.figures) {
    std::printf("%-34s %10.2f %10.2f %9s %s\n", figure.name.c_str(), figure.before, figure.after,
                dashed("%+.1f %%", figure.change_percent).c_str(),
                figure.worse    ? "WORSE"
                : figure.judged ? ""
                                : "(not judged)");
  }
  if (!comparison.has_yardsticks)
    std::printf(
        "times are compared as they are; on a shared machine, measure both with --baseline, so that they are scaled by "
        "the time of OpenCV's SIFT\n");
  for (const auto& note : comparison.notes) std::printf("differs: %s\n", note.c_str());
  if (comparison.drift != 1) {
    std::printf("times after are divided by %.3f, the change in the time of OpenCV's SIFT\n", comparison.drift);
  }
  std::printf("%s beyond the noise band of %g %%\n", comparison.regressed() ? "REGRESSION" : "no regression",
              noise_percent);
}

}  // namespace quadedge::cli
