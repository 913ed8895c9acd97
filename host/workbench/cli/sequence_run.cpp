/// \file sequence_run.cpp  Tracks and writes frame by frame; then errors and report.
#include "cli/sequence_run.hpp"

#include <algorithm>
#include <cstdio>

#include "benchmark/variant_comparison.hpp"
#include "cli/console.hpp"
#include "common/printed.hpp"
#include "common/timing.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "device/context.hpp"
#include "geometry/undistortion.hpp"
#include "output/calibration_report.hpp"
#include "output/config_toml.hpp"
#include "output/drawing.hpp"
#include "output/json.hpp"
#include "output/output_folder.hpp"
#include "output/result_rows.hpp"
#include "quadedge/config.hpp"
#include "quadedge/evaluation.hpp"

namespace quadedge::cli {
namespace {

/// Whether this frame is one of `count` that are spread evenly over the frames after the first.
bool is_thumbnail(int frame, int frames, int count) {
  for (int i = 1; i <= count; ++i) {
    if (frame > 0 && frame == static_cast<int>(static_cast<std::int64_t>(frames) * i / (count + 1))) return true;
  }
  return false;
}

/// Draws edges and quads of the frame tracked last, if it is a chosen one. `frames`: length of the sequence.
void draw_frame(const FramePrefetcher::Frame& frame, int frames, const StereoRig& rig, const StereoOdometry& odometry,
                const SequenceRunOptions& options) {
  const bool large =
      options.draw_every > 0 ? frame.number % options.draw_every == 0 : frame.number == options.draw_frame;
  const bool small = is_thumbnail(frame.number, frames, options.thumbnails);
  const bool example = is_thumbnail(frame.number, frames, options.thumbnails > 0 ? 1 : 0);
  if (!large && !small && !example) return;
  const FrameDetails details = odometry.details();
  // Edges refer to the pinhole image, not to the recorded one with distortion.
  const auto& table = rig.left_undistortion;
  const Image left = table.empty() ? frame.left : undistort(frame.left.view(), table);
  const std::string number = printed("%06d", frame.number);
  if (example)
    report::draw_pair(options.output + "/pictures/pair_" + number + ".jpg", frame.left.view(), frame.right.view());
  if (small)
    report::draw_quads_thumbnail(options.output + "/pictures/thumbnail_" + number + ".jpg", left.view(), details);
  if (!large) return;
  report::draw_edges(options.output + "/pictures/edges_" + number + ".png", left.view(), details.left_edges);
  report::draw_quads(options.output + "/pictures/quads_" + number + ".png", left.view(), details);
}

/// Builds the pipeline and reports it: where the driver keeps no kernels from an earlier run this takes a while.
std::unique_ptr<StereoOdometry> start_odometry(const StereoRig& rig, Device& device, bool quiet,
                                               report::RunRecord& run) {
  StatusLine status(quiet);
  const bool builds = !device.is_reference();
  if (builds) status.show("building kernels for " + device.info().name);
  auto odometry = std::make_unique<StereoOdometry>(rig, device, run.config);
  run.config = odometry->config();
  run.kernel_build_ms = odometry->kernel_build_ms();
  if (builds) status.show(printed("programs built in %.1f s", run.kernel_build_ms / 1000), true);
  return odometry;
}

/// Says how much of an interrupted rendering the next run will find.
void note_cache(const FrameSource& source) {
  const data::RenderedFrames* rendered = source.rendered();
  if (rendered == nullptr || rendered->folder().empty()) return;
  note(std::to_string(rendered->ready()) + " of " + std::to_string(rendered->sequence().frames()) +
       " rendered frames are cached in " + rendered->folder());
}

/// After a signal before the first frame: ends the process.
void end_if_interrupted(const Interruption& interruption, const FrameSource& source) {
  if (interruption.signal() == 0) return;
  note("interrupted before the first frame was tracked");
  note_cache(source);
  interruption.end_process();
}

/// Reports warnings about the recording, why a frame was lost where the one before was not lost for the same reason,
/// and every new segment.
void report_warnings(const FrameResult& result, const report::RunRecord& run) {
  const std::string warning = "warning: frame " + std::to_string(run.frames.size()) + ": ";
  for (const Warning& found : result.warnings) note(warning + found.text);
  const bool is_new = run.frames.empty() || run.frames.back().status != result.status;
  if (!is_tracked(result.status) && is_new) note(warning + "lost: " + result.message);
  const bool starts_segment = !run.frames.empty() && run.frames.back().segment != result.segment;
  if (starts_segment && result.warnings.empty()) note(warning + result.message);
}

/// Opens the device and reports its self-test.
Device open_tested_device(const MethodOptions& method, report::RunRecord& run) {
  SelfTestResult test;
  Device device = method.open_device(false, &test);
  run.self_test = {device.is_reference() ? "not needed" : test.passed() ? "passed" : "failed", test};
  if (!test.passed()) {
    note("warning: the device fails the self-test at stage " + test.stage + " (" + test.difference +
         "); it is used because of --trust");
  }
  return device;
}

double device_peak_mb(const Device& device, const StereoOdometry& odometry) {
  const std::size_t peak = device.is_reference() ? 0 : device.context()->peak_bytes();
  return static_cast<double>(std::max(peak, odometry.device_bytes())) / (1024.0 * 1024.0);
}

void show_progress(const report::RunRecord& run, int lost, Progress& progress) {
  const std::string text = printed("%d lost, %.0f ms", lost, run.frames.back().timing.latency_ms);
  progress.update(run.input.name + " frame", static_cast<int>(run.frames.size()), run.input.frames, text);
}

/// Poses and latencies. LONG: what a frame passes through, in its order.
void track_frames(FrameSource& source, const MethodOptions& method, const SequenceRunOptions& options,
                  const Interruption& interruption, PointsOutput& points, EdgeSample& sample, report::RunRecord& run) {
  const auto opening = Clock::now();
  Device device = open_tested_device(method, run);
  bench::add_saved_variants(device, run.config);
  const auto pipeline = start_odometry(source.rig(), device, options.quiet, run);
  StereoOdometry& odometry = *pipeline;
  std::optional<LoopOutput> loops;
  if (options.loops) loops.emplace(odometry);
  run.start_ms = milliseconds_since(opening);
  run.device = device.info();
  run.variants = odometry.variants();
  source.prepare();
  if (source.rendered() != nullptr && !source.rendered()->cache_error().empty())
    note("warning: rendered frames are not cached: " + source.rendered()->cache_error());
  end_if_interrupted(interruption, source);  // OUT has no results yet, so the next start needs no --force
  data::write_atomically(options.output + "/config.toml", report::config_toml(run.config, method.device_choice()));
  if (options.learned) {
    write_calibration(options.output + "/rig.yaml", options.learned->calibration);
    data::write_atomically(options.output + "/rig.json", report::calibration_json(*options.learned, run.command));
  }
  report::GrowingFiles files(options.output);
  Progress progress(options.quiet, "frames");
  int lost = 0;
  const auto write_loops = [&](bool after_error) {
    if (!loops) return;
    points.correct(loops->finish(after_error));
    run.loops = loops->write(options.output, options.saved_map);
  };
  try {
    while (const auto frame = source.next()) {
      if (options.restarts && !run.frames.empty() && frame->stamp_ns < run.frames.back().stamp_ns) odometry.restart();
      FrameResult result = odometry.track(frame->view());
      files.add(result);
      report_warnings(result, run);
      draw_frame(*frame, run.input.frames, odometry.rig(), odometry, options);
      points.add(*frame, result, odometry);
      sample.add(odometry, result);
      if (loops) loops->add(result);
      lost += is_tracked(result.status) ? 0 : 1;
      run.frames.push_back(std::move(result));
      show_progress(run, lost, progress);
      if (interruption.signal() != 0) break;
    }
    write_loops(false);
  } catch (const Error&) {
    if (run.frames.empty()) throw;
    try {
      write_loops(true);
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a full disk, beside the error that ends the run
    }
    throw;
  }
  if (run.input.frames == 0) run.input.frames = static_cast<int>(run.frames.size());
  run.input.dropped = source.dropped();
  run.device_peak_mb = device_peak_mb(device, odometry);
  run.host_peak_mb = host_peak_mb();
}

Trajectory tracked_poses(const report::RunRecord& run) {
  Trajectory trajectory;
  for (const auto& frame : run.frames) {
    if (frame.world_from_left) trajectory.push_back({frame.stamp_ns, *frame.world_from_left, frame.segment});
  }
  return trajectory;
}

/// The poses of the ground truth that can be compared with the run: those of its duration.
Trajectory truth_of_the_run(const Trajectory& truth, const report::RunRecord& run) {
  Trajectory kept;
  if (run.frames.empty()) return kept;
  for (const auto& pose : truth) {
    if (pose.stamp_ns >= run.frames.front().stamp_ns - kStampToleranceNs &&
        pose.stamp_ns <= run.frames.back().stamp_ns + kStampToleranceNs) {
      kept.push_back(pose);
    }
  }
  return kept;
}

/// Compares with the ground truth, if any. Ground truth that misses most frames does not make a finished run fail.
void evaluate(const FrameSource& source, const SequenceRunOptions& options, report::RunRecord& run) {
  if (source.dataset().truth.empty()) return;
  run.truth_file = source.dataset().truth_file;
  write_tum(options.output + "/groundtruth.txt", truth_of_the_run(source.dataset().truth, run));
  try {
    run.accuracy = evaluate_trajectory(tracked_poses(run), source.dataset().truth);
    const std::vector<FrameResult> results(run.frames.begin(), run.frames.end());
    run.step_consistency = evaluation::judge_steps(results, source.dataset().truth, run.config.pose);
    data::write_atomically(options.output + "/errors.csv", report::errors_csv(*run.accuracy));
    const int missing = run.accuracy->estimate_poses - run.accuracy->matched;
    if (missing > 0) {
      note("warning: " + run.truth_file + ": ground truth covers " + std::to_string(run.accuracy->matched) + " of " +
           std::to_string(run.accuracy->estimate_poses) + " tracked frames; accuracy is given for those alone");
    }
  } catch (const DataError& error) {
    note(std::string("warning: no accuracy: ") + error.what());
  }
}

/// A file per segment beside the whole, for programs that take every file for one path; none for a single segment.
void write_segments(const std::string& folder, const Trajectory& trajectory) {
  const std::vector<Trajectory> segments = split_segments(trajectory);
  if (segments.size() < 2) return;
  for (const Trajectory& segment : segments)
    write_tum(folder + "/" + report::kSegmentFile + std::to_string(segment.front().segment) + ".txt", segment);
}

/// Writes what depends on all frames: accuracy and report.json.
void write_results(const FrameSource& source, const SequenceRunOptions& options, const EdgeSample& sample,
                   report::RunRecord& run) {
  write_segments(options.output, tracked_poses(run));
  evaluate(source, options, run);
  data::write_atomically(options.output + "/edges.csv", sample.csv());
  data::write_atomically(options.output + "/report.json", report::report_json(run));
}

/// Prints the summary of an interrupted run and ends the process by the signal.
[[noreturn]] void end_by_signal(const Interruption& interruption, const FrameSource& source,
                                const SequenceRunOptions& options, const report::RunRecord& run) {
  print_run(run, options.output);
  std::fflush(stdout);
  note(run.ended_early + "; results of these frames are in " + options.output);
  note_cache(source);
  interruption.end_process();
}

}  // namespace

report::RunRecord run_sequence(FrameSource& source, const MethodOptions& method, const SequenceRunOptions& options,
                               const Interruption& interruption) {
  report::RunRecord run;
  run.command = command_line();
  run.input = source.facts();
  run.config = method.config();
  const std::vector<std::string> files = {options.saved_map, options.points.ply};
  report::check_beside_results(files, options.output, run.input.path);
  const report::FolderLock lock = report::prepare_output_folder(options.output, options.force);
  report::check_output_file(options.saved_map, options.force);
  options.points.check(options.force);
  PointsOutput points(options.points, run.config);
  EdgeSample sample;
  try {
    track_frames(source, method, options, interruption, points, sample, run);
  } catch (const Error& error) {
    if (run.frames.empty()) throw;
    run.ended_early = error.what();
    end_with_error(error, run.frames.size(), options.output,
                   {[&] {
                      points.write();
                      run.points = points.facts();
                    },
                    [&] { write_results(source, options, sample, run); }});
  }
  if (run.frames.empty()) end_if_interrupted(interruption, source);
  points.write();
  run.points = points.facts();
  if (interruption.signal() != 0) {
    const bool knows_all = run.input.frames > static_cast<int>(run.frames.size());
    run.ended_early = "interrupted after " + (knows_all ? std::to_string(run.frames.size()) + " of " : "") +
                      data::counted(knows_all ? run.input.frames : static_cast<int>(run.frames.size()), "frame");
  }
  write_results(source, options, sample, run);
  if (interruption.signal() != 0) end_by_signal(interruption, source, options, run);
  return run;
}

int exit_code(const report::RunRecord& run, double min_tracked) {
  return exit_code("tracked", run.tracked(), run.frames.size(), min_tracked, report::lost_reasons(run.frames));
}

int exit_code(const char* verb, int done, std::size_t frames, double min_tracked, const std::string& lost) {
  if (frames > 0 ? 100.0 * done >= min_tracked * static_cast<double>(frames) : min_tracked == 0)
    return static_cast<int>(ExitCode::done);
  std::fprintf(stderr, "quadedge: %s %d of %s, fewer than --min-tracked %g %%%s%s\n", verb, done,
               data::counted(frames, "frame").c_str(), min_tracked, lost.empty() ? "" : "; lost: ", lost.c_str());
  return static_cast<int>(ExitCode::too_few_tracked);
}

void end_with_error(const Error& error, std::size_t frames, const std::string& folder,
                    std::initializer_list<std::function<void()>> parts) {
  for (const auto& part : parts) {
    try {
      part();
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a full disk, beside what `error` reports
    }
  }
  throw Error(error.exit_code(),
              std::string(error.what()) + "\n" + data::counted(frames, "finished frame") + " in " + folder);
}

}  // namespace quadedge::cli
