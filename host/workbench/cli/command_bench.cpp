/// \file command_bench.cpp  quadedge bench: latency, kernel times and memory, and comparing two such results.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "benchmark/bench_record.hpp"
#include "benchmark/latency.hpp"
#include "benchmark/variant_comparison.hpp"
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/method_options.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "output/json.hpp"
#include "output/output_folder.hpp"
#include "output/statistics.hpp"
#include "quadedge/error.hpp"

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
  std::printf("  %-20s %9.2f %5.1f %%   the device waits for the host, mainly for poses\n", "host", shares.host_ms(),
              100 * shares.host_ms() / shares.frame_ms);
  std::printf("  %-20s %9.2f %5.1f %% %9.2f %9.2f %9.2f %9.1f\n", "frame", shares.frame_ms, 100.0, sum.kernel_ms,
              sum.transfer_ms, sum.queue_ms, sum.launches);
}

double count(const report::RunRecord& run, const std::string& name) {
  for (const auto& [key, value] : report::count_medians(run.frames)) {
    if (key == name) return value;
  }
  return NAN;
}

/// What was measured.
void print_benchmark(const bench::BenchRecord& record) {
  const auto& run = record.run;
  std::printf("%s, %dx%d, on %s\n", run.input.name.c_str(), run.input.width, run.input.height, run.device.name.c_str());
  std::printf("measured frames: %d, after the first and %d for warm-up; tracked: %d of %zu\n",
              static_cast<int>(run.frames.size()) - 1, record.warm_up, run.tracked(), run.frames.size());
  std::printf("edge threshold %.4g%s: %.0f and %.0f edges per image, %.0f stereo edges, %.0f quads\n",
              run.frames.back().diagnostics.edge_threshold, record.edges_wanted > 0 ? " (chosen)" : "",
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
  std::printf("kernel build      %.0f ms of it; some drivers finish compiling when a kernel first runs\n",
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

/// Every figure of both results, what else differs, and the verdict.
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

constexpr int kYardstickRepetitions = 7;

class BenchCommand : public Command {
 public:
  BenchCommand()
      : Command("bench", "measure the latency of every frame, kernel times and memory, or compare two results",
                "  quadedge bench --baseline --json now.json\n"
                "  quadedge bench --compare before.json now.json") {}
  void declare(Options& options) override {
    source_.declare_path(options, "recorded sequence; default: the built-in one. With --compare also a result file");
    options.choice("--scene", scene_.scene, synthetic_scenes(), "built-in scene");
    declare_view(options, scene_, size_);
    options.number("--scene-seed", scene_.seed, "seed of the built-in sequence");
    options.number("--edges", edges_, "choose edges.threshold for this number of edges per image; 0: as configured");
    options.number("--frames", frames_, "number of measured frames");
    options.number("--warm-up", warm_up_, "number of frames between the first and the measured ones");
    options.flag(
        "--baseline", baseline_,
        "also time two OpenCV yardsticks: SIFT on both images, nine filters of 17 coefficients (--preset paper: 33)");
    options.output("--json", json_, "write all figures");
    options.text("--compare", compare_, "print the differences from an older result; exit code 6 for a regression",
                 "OLD.json");
    options.number("--noise", noise_, "noise band: increases of up to this count as equal [percent]");
    options.flag("--force", force_, "overwrite existing files");
    options.flag("--quiet", quiet_, "hide progress");
    source_.declare(options);
    method_.declare(options);
  }

  int run() override {
    path_ = source_.path();
    check_options();
    const bool compare_files = !compare_.empty() && std::filesystem::is_regular_file(path_);
    if (compare_files) return compare(path_);
    report::check_output_file(json_, force_);
    const bench::BenchRecord record = measure();
    print_benchmark(record);
    const std::string text = bench::bench_json(record);
    if (!json_.empty()) data::write_atomically(json_, text);
    if (compare_.empty()) return static_cast<int>(ExitCode::done);
    std::printf("\n");
    return compare(json_);
  }

 private:
  void check_options() const {
    if (frames_ < 1) throw UsageError("--frames " + std::to_string(frames_) + ": expected 1 or more");
    if (warm_up_ < 0) throw UsageError("--warm-up " + std::to_string(warm_up_) + ": expected 0 or more");
    if (edges_ < 0) throw UsageError("--edges " + std::to_string(edges_) + ": expected 0 or more");
    if (!(noise_ >= 0)) throw UsageError("--noise: expected 0 percent or more");
    const SyntheticOptions usual;
    if (source_.is_given() &&
        (!size_.empty() || scene_.scene != usual.scene || scene_.path != usual.path || scene_.seed != usual.seed))
      throw UsageError("--size, --scene, --path and --scene-seed are for the built-in sequence");
    if (!compare_.empty() && !std::filesystem::is_regular_file(path_) && json_.empty()) {
      throw UsageError("--compare: expected a second result file, or --json FILE for this measurement");
    }
    method_.config();
  }

  int compare(const std::string& newer) const {
    const auto comparison = bench::compare_benchmarks(compare_, newer, noise_);
    print_comparison(comparison, noise_);
    return comparison.regressed() ? bench::kRegressionExitCode : static_cast<int>(ExitCode::done);
  }

  FrameSource open_source() const {
    if (source_.is_given()) return FrameSource(source_.open());
    SyntheticOptions scene = scene_;
    scene.frames = 1 + warm_up_ + frames_;
    set_size(scene, size_);
    return FrameSource(scene, quiet_);
  }

  /// \throws DataError for fewer frames than one to measure needs.
  void check_length(const report::InputFacts& input) const {
    if (input.frames >= warm_up_ + 2) return;
    throw DataError(input.path + ": found " + data::counted(input.frames, "frame") + "; expected at least " +
                    std::to_string(warm_up_ + 2) + ": the first, " + std::to_string(warm_up_) +
                    " for warm-up, one to measure");
  }

  bench::BenchRecord measure() {
    bench::BenchRecord record;
    auto& run = record.run;
    FrameSource source = open_source();
    run.input = source.facts();
    run.config = method_.config();
    record.command = command_line();
    record.warm_up = warm_up_;
    Progress progress(quiet_);
    const bool is_counted = run.input.frames > 0;
    if (is_counted) check_length(run.input);
    bench::measure_start(
        source.rig(), [&] { return method_.open_device(); }, bench::add_saved_variants, record);
    std::vector<FramePrefetcher::Frame> frames;
    const int all = 1 + warm_up_ + frames_, wanted = is_counted ? std::min(all, run.input.frames) : all;
    while (static_cast<int>(frames.size()) < wanted) {
      auto frame = source.next();
      if (!frame) break;
      record.frames_mb +=
          static_cast<double>(frame->left.pixels.size() + frame->right.pixels.size()) / (1024.0 * 1024.0);
      frames.push_back(std::move(*frame));
      progress.update("reading frame", static_cast<int>(frames.size()), wanted);
    }
    run.input.frames = static_cast<int>(frames.size());
    check_length(run.input);
    record.edges_wanted = edges_;
    if (record.edges_wanted > 0) {
      Device device = method_.open_device();
      run.config.edges.threshold = bench::threshold_for_edges(frames.front(), record.edges_wanted, device, run.config);
    }
    const bench::Subject subject{source.rig(), frames, run.config,
                                 [&](bool profiling) { return method_.open_device(profiling); },
                                 [&](const char* pass, int done, int total) { progress.update(pass, done, total); }};
    bench::measure_latency(subject, record);
    bench::measure_edge_detection(subject, std::max(frames_, 10), record);
    if (baseline_) {
      record.yardsticks = bench::measure_yardsticks(
          frames.front(), run.config.is_paper() ? 2 : 1, record.threads, kYardstickRepetitions,
          [&](int done, int total) { progress.update("yardsticks", done, total); });
    }
    bench::measure_kernels(subject, record);
    return record;
  }

  SyntheticOptions scene_;
  SourceOptions source_;
  std::string path_, size_, json_, compare_;
  int edges_ = 0, frames_ = 30, warm_up_ = 3;
  double noise_ = 10;
  bool baseline_ = false, force_ = false, quiet_ = false;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_bench_command() { return std::make_unique<BenchCommand>(); }

}  // namespace quadedge::cli
