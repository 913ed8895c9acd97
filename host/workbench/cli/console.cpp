/// \file console.cpp  Rewrites one line on a terminal, prints at intervals elsewhere; tables of runs and evaluations.
#include "cli/console.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sys/ioctl.h>
#include <unistd.h>

#include "common/printed.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {

namespace {

/// Whether a stream (STDERR_FILENO) is a terminal that understands escape codes: not with TERM=dumb, nor without TERM.
bool has_escape_codes(int stream) {
  const char* kind = std::getenv("TERM");
  return isatty(stream) != 0 && kind != nullptr && *kind != '\0' && std::strcmp(kind, "dumb") != 0;
}

/// Columns of the terminal that a stream goes to: COLUMNS if set, else the terminal's own value; 0: no terminal.
int terminal_width(int stream) {
  if (const char* columns = std::getenv("COLUMNS"); columns != nullptr) {
    int width = 0;
    const char* const end = columns + std::strlen(columns);
    const auto [rest, error] = std::from_chars(columns, end, width);
    if (error == std::errc() && rest == end && width > 0) return width;
  }
  winsize window{};
  return ioctl(stream, TIOCGWINSZ, &window) == 0 ? window.ws_col : 0;
}

constexpr std::chrono::seconds kPlainInterval{5};            // between two lines of a log
constexpr std::chrono::milliseconds kTerminalInterval{100};  // between two updates of a terminal's line

void print_errors(const char* title, const PoseErrors& errors) {
  std::printf("\n%s\n", title);
  if (!std::isfinite(errors.ape_translation_m.mean)) {
    std::printf("undefined: all positions lie on one line\n");
    return;
  }
  std::printf("%-22s %12s %12s %12s %12s\n", "", "mean", "std", "rmse", "max");
  const auto row = [](const char* name, const ErrorStatistics& error) {
    std::printf("%-22s", name);
    for (const double value : {error.mean, error.std, error.rmse, error.max})
      std::printf(" %12s", dashed("%.7f", value).c_str());
    std::printf("\n");
  };
  row("APE rotation [deg]", errors.ape_rotation_deg);
  row("APE translation [m]", errors.ape_translation_m);
  row("RPE rotation [deg]", errors.rpe_rotation_deg);
  row("RPE translation [m]", errors.rpe_translation_m);
}

std::string milliseconds(double value) { return dashed("%.1f ms", value); }

/// "47 s", "2 min 05 s", "1 h 03 min".
std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return printed("%ld s", whole);
  if (whole < 3600) return printed("%ld min %02ld s", whole / 60, whole % 60);
  return printed("%ld h %02ld min", whole / 3600, whole / 60 % 60);
}

/// "1.4 frames/s, 2 min 05 s left" for `done` of `total` after a time; empty while nothing is done yet.
std::string rate_and_rest(int done, int total, const std::string& unit, std::chrono::steady_clock::duration elapsed) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  if (done <= 0 || seconds <= 0) return {};
  const double rate = done / seconds;
  const std::string text = printed("%.*f%s%s/s", rate < 10 ? 1 : 0, rate, unit.empty() ? "" : " ", unit.c_str());
  return done < total ? text + ", " + duration_text((total - done) / rate) + " left" : text;
}

/// t_rel and r_rel per length, and over the sub-paths of all; nothing where the path is too short for any.
void print_sub_paths(const TrajectoryEvaluation& evaluation) {
  if (evaluation.sub_path_mean.count == 0) return;
  std::printf("\nrelative errors over sub-paths from every tenth pose (KITTI)\n%-10s %9s %10s %16s %20s\n",
              "length [m]", "sub-paths", "t_rel [%]", "r_rel [deg/m]", "r_rel [deg/100 m]");
  const auto row = [](const char* name, const SubPathErrors& errors) {
    std::printf("%-10s %9d %10.4f %16.6f %20.4f\n", name, errors.count, errors.translation_percent,
                errors.rotation_deg_per_m, 100 * errors.rotation_deg_per_m);
  };
  for (const SubPathErrors& errors : evaluation.sub_paths) {
    char length[32];
    std::snprintf(length, sizeof length, "%g", errors.length_m);
    if (errors.count > 0) row(length, errors);
  }
  row("all", evaluation.sub_path_mean);
}

/// Each segment by itself, in one row.
void print_segments(const std::vector<TrajectoryEvaluation>& segments) {
  std::printf(
      "\nsegments, each aligned by itself: mean errors, origin-aligned; end drift\n%-8s %6s %10s %11s %11s %11s %11s "
      "%9s\n",
      "segment", "poses", "path [m]", "APE [deg]", "APE [m]", "RPE [deg]", "RPE [m]", "drift [%]");
  for (const auto& segment : segments) {
    const PoseErrors& errors = segment.origin_aligned;
    std::printf("%-8d %6d %10.3f", segment.segment, segment.matched, segment.path_length_m);
    for (const double value : {errors.ape_rotation_deg.mean, errors.ape_translation_m.mean,
                               errors.rpe_rotation_deg.mean, errors.rpe_translation_m.mean})
      std::printf(" %11s", dashed("%.6f", value).c_str());
    std::printf(" %9s\n", dashed("%.3f", segment.end_drift_percent).c_str());
  }
}

/// "0.0483 mm": lengths below 10 cm in millimetres.
std::string length(double metres) {
  return std::abs(metres) < 0.1 ? dashed("%.3g mm", 1e3 * metres) : dashed("%.3g m", metres);
}

void print_time(const report::RunRecord& run) {
  const report::LatencySummary time = report::latency_summary(run.frames);
  const auto first = run.frames.begin() + (run.frames.empty() ? 0 : 1);  // the first frame is reported by itself
  const auto slowest = std::max_element(
      first, run.frames.end(), [](const auto& a, const auto& b) { return a.timing.latency_ms < b.timing.latency_ms; });
  std::printf("time       %s per frame (median), p99 %s, at most %s in frame %td\n", milliseconds(time.median).c_str(),
              milliseconds(time.p99).c_str(), milliseconds(time.max).c_str(), slowest - run.frames.begin());
  if (run.loops)
    std::printf("           with loops: median %s, p99 %s\n", milliseconds(run.loops->latency.median).c_str(),
                milliseconds(run.loops->latency.p99).c_str());
}

/// Path and loops, and with ground truth the two errors that say most.
void print_path(const report::RunRecord& run) {
  std::printf("path       %.3f m (estimated)\n", report::path_length_m(run.frames));
  if (run.loops) {
    std::printf("loops      %s kept of %zu compared; %zu frames in the largest of %s\n",
                data::counted(run.loops->kept, "closure").c_str(), run.loops->compared, run.loops->frames,
                data::counted(run.loops->segments, "segment").c_str());
  }
  if (!run.accuracy) return;
  const PoseErrors& errors = run.accuracy->origin_aligned;
  std::printf("error      %s and %s per frame (mean), drift %s of %.3f m; ground truth of %d frames\n",
              length(errors.rpe_translation_m.mean).c_str(), dashed("%.2g deg", errors.rpe_rotation_deg.mean).c_str(),
              dashed("%.3f %%", run.accuracy->end_drift_percent).c_str(), run.accuracy->path_length_m,
              run.accuracy->matched);
}

/// How many frames were tracked, why others were not, and where the trajectory is broken.
void print_tracked(const report::RunRecord& run) {
  const int frames = static_cast<int>(run.frames.size());
  std::printf("tracked    %d of %s\n", run.tracked(), data::counted(frames, "frame").c_str());
  const std::string lost = report::lost_reasons(run.frames);
  if (!lost.empty()) std::printf("lost       %s\n", lost.c_str());
  const std::string segments = report::segments_text(run.frames);
  if (!segments.empty()) std::printf("broken     %s\n", segments.c_str());
  if (run.input.dropped > 0) {
    std::printf("dropped    %s from the pipe, which came faster than they were tracked\n",
                data::counted(run.input.dropped, "pair").c_str());
  }
}

/// The words that this process was started with.
std::vector<std::string> process_words() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(stream, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace

StatusLine::StatusLine(bool quiet)
    : quiet_(quiet), terminal_(has_escape_codes(STDERR_FILENO)), shown_(std::chrono::steady_clock::now()) {}

StatusLine::~StatusLine() { end_line(); }

void StatusLine::end_line() {
  if (line_open_) std::fputs("\n", stderr);
  line_open_ = false;
}

bool StatusLine::due(bool last) const {
  if (quiet_) return false;
  const auto interval = terminal_ ? kTerminalInterval : std::chrono::milliseconds(kPlainInterval);
  return last || std::chrono::steady_clock::now() - shown_ >= interval;
}

void StatusLine::show(const std::string& sentence, bool last) {
  if (quiet_) return;
  const std::string text = visible(sentence);
  shown_ = std::chrono::steady_clock::now();
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  // A longer line would wrap, and only its end would be written over.
  const int width = terminal_width(STDERR_FILENO);
  std::fprintf(stderr, "\r%s\x1b[K",
               width > 1 ? text.substr(0, static_cast<std::size_t>(width) - 1).c_str() : text.c_str());
  line_open_ = true;
  if (last) end_line();
}

void Progress::update(const std::string& what, int done, int total, const std::string& note) {
  const auto now = std::chrono::steady_clock::now();
  if (what != what_) start_ = updated_;
  what_ = what;
  updated_ = now;
  const bool last = done == total;
  if (!status_.due(last)) return;
  std::string line = what + " " + std::to_string(done);
  if (total > 0) line += "/" + std::to_string(total);
  for (const auto& part : {total > 0 ? rate_and_rest(done, total, unit_, now - start_) : std::string(), note}) {
    line += part.empty() ? "" : "  " + part;
  }
  status_.show(line, last);
}

std::string dashed(const char* format, double value) { return std::isfinite(value) ? printed(format, value) : "-"; }

std::string command_line() {
  std::string line = "quadedge";
  const auto words = process_words();
  for (std::size_t i = 1; i < words.size(); ++i) line += " " + words[i];
  return line;
}

void print_error(const std::string& message) { std::fprintf(stderr, "quadedge: %s\n", message.c_str()); }

void note(const std::string& sentence) {
  // Replaces the progress line, which is shown again with the next frame.
  std::fprintf(stderr, "%squadedge: %s\n", has_escape_codes(STDERR_FILENO) ? "\r\x1b[K" : "",
               visible(sentence).c_str());
}

void print_run(const report::RunRecord& run, const std::string& output) {
  std::printf("sequence   %s (%s), %s of %d x %d\n", visible(run.input.name).c_str(), run.input.format.c_str(),
              data::counted(static_cast<int>(run.frames.size()), "frame").c_str(), run.input.width, run.input.height);
  if (run.config.is_paper()) {
    std::printf("method     the paper's own (doc/paper.md)%s\n",
                run.config.pose.refine ? " with least squares added" : "");
  }
  std::printf("device     %s (%s, %s)\n", run.device.name.c_str(), run.device.platform.c_str(),
              run.device.type.c_str());
  print_tracked(run);
  print_path(run);
  print_time(run);
  const auto words = process_words();
  const bool is_path = !words.empty() && words[0].find('/') != std::string::npos;
  const std::string command =
      (is_path ? data::shell_word(words[0]) : "quadedge") + " report " + data::shell_word(output);
  std::printf("results    %s/trajectory.txt (TUM format); report.json has all figures\n", output.c_str());
  std::printf("next       %s    # makes a page with plots: %s/report.html\n", command.c_str(), output.c_str());
}

void print_evaluation(const TrajectoryEvaluation& evaluation) {
  std::printf("\nground truth: %d of %d estimated poses compared, path %.3f m, end drift %s\n", evaluation.matched,
              evaluation.estimate_poses, evaluation.path_length_m,
              dashed("%.3f %%", evaluation.end_drift_percent).c_str());
  print_errors("origin-aligned (the first compared poses made equal)", evaluation.origin_aligned);
  print_errors("SE(3)-aligned (least squares over all positions, no scale)", evaluation.se3_aligned);
  if (std::isfinite(evaluation.se3_aligned.ape_translation_m.mean) && !evaluation.se3_open_rotation.empty())
    std::printf("no APE rotation: %s\n", evaluation.se3_open_rotation.c_str());
  std::printf("\nATE RMSE %s m (SE(3)-aligned); RPE over 1 frame, %s s\n",
              dashed("%.4f", evaluation.se3_aligned.ape_translation_m.rmse).c_str(),
              dashed("%.4f", evaluation.rpe_interval_s).c_str());
  print_sub_paths(evaluation);
  if (!evaluation.segments.empty()) print_segments(evaluation.segments);
}

}  // namespace quadedge::cli
