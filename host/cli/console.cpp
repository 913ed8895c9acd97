#include "cli/console.hpp"

#include <unistd.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>

namespace quadedge::cli {
namespace {

constexpr std::chrono::seconds kPlainInterval{5};           // between two lines of a log
constexpr std::chrono::milliseconds kTerminalInterval{100};  // between two updates of a terminal's line

void print_errors(const char* title, const PoseErrors& errors) {
  std::printf("\n%s\n", title);
  if (!std::isfinite(errors.ape_translation_m.mean)) {
    std::printf("not defined: all positions lie on one line\n");
    return;
  }
  std::printf("%-22s %12s %12s %12s %12s\n", "", "mean", "std", "rmse", "max");
  const auto row = [](const char* name, const ErrorStatistics& error) {
    std::printf("%-22s %12.7f %12.7f %12.7f %12.7f\n", name, error.mean, error.std, error.rmse, error.max);
  };
  row("APE rotation [deg]", errors.ape_rotation_deg);
  row("APE translation [m]", errors.ape_translation_m);
  row("RPE rotation [deg]", errors.rpe_rotation_deg);
  row("RPE translation [m]", errors.rpe_translation_m);
}

/// A time that may not exist.
std::string milliseconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f ms", value);
  return std::isfinite(value) ? text : "-";
}

}  // namespace

Progress::Progress(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), last_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { end_line(); }

void Progress::end_line() {
  if (line_open_) std::fputs("\n", stderr);
  line_open_ = false;
}

void Progress::update(const std::string& what, int done, int total, const std::string& note) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  const bool last = done == total;
  if (!last && now - last_ < (terminal_ ? kTerminalInterval : std::chrono::milliseconds(kPlainInterval))) return;
  last_ = now;
  const std::string line = what + " " + std::to_string(done) + "/" + std::to_string(total) + (note.empty() ? "" : "  " + note);
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", line.c_str());
    return;
  }
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  line_open_ = true;
  if (last) end_line();
}

void note(bool quiet, const std::string& sentence) {
  if (!quiet) std::fprintf(stderr, "quadedge: %s\n", sentence.c_str());
}

void print_run(const report::RunRecord& run, const std::string& output) {
  const int frames = static_cast<int>(run.frames.size());
  int key_rigs = 0;
  for (const auto& frame : run.frames) key_rigs += frame.result.new_key_rig ? 1 : 0;
  std::printf("sequence   %s (%s), %d frames of %d x %d\n", run.input.name.c_str(), run.input.format.c_str(), frames,
              run.input.width, run.input.height);
  std::printf("device     %s (%s, %s)\n", run.device.name.c_str(), run.device.platform.c_str(), run.device.type.c_str());
  std::printf("tracked    %d of %d frames, %d key stereo rigs\n", run.tracked(), frames, key_rigs);
  const auto latency = report::latency_summary(run.frames);
  std::printf("latency    median %s, p90 %s, p99 %s, max %s; first frame %s\n", milliseconds(latency.median).c_str(),
              milliseconds(latency.p90).c_str(), milliseconds(latency.p99).c_str(), milliseconds(latency.max).c_str(),
              milliseconds(latency.first).c_str());
  std::printf("counts    ");
  for (const auto& [name, value] : report::count_medians(run.frames)) std::printf(" %s %.0f", name.c_str(), value);
  std::printf(" (medians)\n");
  std::printf("start      %s, of it kernel builds %s\n", milliseconds(run.start_ms).c_str(), milliseconds(run.kernel_build_ms).c_str());
  std::printf("memory     host %.0f MB, device %.0f MB (peaks)\n", run.host_peak_mb, run.device_peak_mb);
  if (!run.kernel_times.empty()) {
    std::printf("\nkernel times of the profiling pass [ms]\n%-22s %12s %12s\n", "", "median", "p90");
    for (const auto& stage : report::stage_summary(run.kernel_times)) {
      std::printf("%-22s %12.3f %12.3f\n", stage.stage.c_str(), stage.median, stage.p90);
    }
  }
  if (run.accuracy) print_evaluation(*run.accuracy);
  std::printf("\nresults in %s\n", output.c_str());
}

void print_evaluation(const TrajectoryEvaluation& evaluation) {
  std::printf("\nground truth: %d of %d estimated poses compared, path %.3f m, end drift %.3f %%\n", evaluation.matched,
              evaluation.estimate_poses, evaluation.path_length_m, evaluation.end_drift_percent);
  print_errors("origin-aligned (the first compared poses made equal)", evaluation.origin_aligned);
  print_errors("SE(3)-aligned (least squares over all positions, no scale)", evaluation.se3_aligned);
}

}  // namespace quadedge::cli
