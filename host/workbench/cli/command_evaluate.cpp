/// \file command_evaluate.cpp  quadedge evaluate trajectory: APE and RPE of a trajectory file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "output/json.hpp"
#include "output/motion_errors.hpp"
#include "output/output_folder.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "quadedge/evaluation.hpp"

namespace quadedge::cli {
namespace {

/// A trajectory and whether its stamps are times (TUM, data sets) or row numbers (KITTI).
struct Loaded {
  Trajectory poses;
  bool timed = true;
};

/// Sets the segments of the frames of a run, and removes those that were lost, whose rows are predictions, if its
/// frames.csv is beside the KITTI file, which says neither. \returns how many were removed before `from_frame`
int read_frames(Trajectory& rows, const std::string& file, std::size_t from_frame) {
  const std::string frames_csv = std::filesystem::path(file).replace_filename("frames.csv").string();
  if (!std::filesystem::is_regular_file(frames_csv)) return 0;
  const auto lines = data::data_lines(frames_csv);
  if (lines.empty() || lines[0].text.rfind("frame,stamp_s,status,segment", 0) != 0) return 0;
  if (lines.size() != rows.size() + 1)
    data::fail(frames_csv, data::counted(lines.size() - 1, "frame"), std::to_string(rows.size()) + " as in " + file);
  Trajectory tracked;
  int lost_before = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto cells = data::split(lines[i + 1].text, ",");
    cells.resize(4);  // of a row that was cut off, the segment is no number
    rows[i].segment = data::parse_whole(cells[3], frames_csv, lines[i + 1].number, "segment", 0, 1 << 30);
    if (cells[2].rfind("lost", 0) != 0)
      tracked.push_back(rows[i]);
    else if (i < from_frame)
      ++lost_before;
  }
  rows = std::move(tracked);
  return lost_before;
}

Loaded load_file(const std::string& path) {
  Loaded loaded;
  loaded.poses = read_trajectory(path);
  const std::string first = data::table_lines(path).front().text;
  const bool is_csv = first.find(',') != std::string::npos;
  loaded.timed = is_csv || data::split(first).size() == 8;
  if (is_csv && std::filesystem::path(path).filename() != "data.csv")
    note("warning: " + path + ": taken for the left camera's poses; a data.csv beside cam0/ is converted by its T_BS");
  return loaded;
}

/// Gives the rows of a KITTI file the stamps of as many other poses.
void give_stamps(Trajectory& rows, const std::vector<std::int64_t>& stamps, const std::string& file,
                 const std::string& timed_file) {
  if (rows.size() != stamps.size()) {
    throw DataError(file + ": found " + data::counted(rows.size(), "row") + " without time stamps, expected " +
                    std::to_string(stamps.size()) + ", one per frame of " + timed_file);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].stamp_ns = stamps[i];
}

std::vector<std::int64_t> stamps_of(const Trajectory& poses) {
  std::vector<std::int64_t> stamps;
  for (const auto& pose : poses) stamps.push_back(pose.stamp_ns);
  return stamps;
}

class EvaluateTrajectoryCommand : public Command {
 public:
  EvaluateTrajectoryCommand()
      : Command("evaluate trajectory", "absolute and relative errors of a trajectory: APE, ATE, RPE, t_rel and r_rel",
                "  quadedge evaluate trajectory results_06/trajectory_kitti.txt kitti/poses/06.txt --from-frame 10\n"
                "  quadedge evaluate trajectory quadedge_V1_01/trajectory.txt V1_01_easy --lengths 1,5,10 --json "
                "errors.json") {}
  void declare(Options& options) override {
    options.positional("ESTIMATE", estimate_, "TUM or KITTI file, or results folder of a run");
    options.positional("TRUTH", truth_, "TUM or KITTI file, or folder of a sequence with ground truth");
    options.text("--lengths", lengths_, "lengths of the sub-paths of t_rel and r_rel [m]; default: KITTI's, 100 to 800",
                 "M[,M...]");
    options.number("--from-frame", from_frame_, "ignore poses of the estimate before this one");
    options.text("--sequence", dataset_.sequence, "KITTI: name of the sequence if TRUTH is a folder with several",
                 "NAME");
    options.flag(
        "--steps", steps_,
        "also classify each step: right if its errors are below a distance + 10 % of the motion and below an angle");
    options.number("--step-metres", step_limits_.translation_m, "distance for --steps [m]");
    options.number("--step-degrees", step_limits_.rotation_deg, "angle for --steps [deg]");
    options.output("--json", json_, "also write the errors, including those of every pose, to a file");
    options.flag("--force", force_, "overwrite the --json file");
  }

  int run() override {
    if (from_frame_ < 0) throw UsageError("--from-frame " + std::to_string(from_frame_) + ": expected 0 or more");
    if (!(step_limits_.translation_m >= 0 && step_limits_.rotation_deg > 0)) {
      throw UsageError("--step-metres, --step-degrees: expected at least 0 m and more than 0 degrees");
    }
    report::check_output_file(json_, force_);
    if (std::filesystem::is_directory(estimate_)) estimate_ += "/trajectory.txt";
    Loaded estimate = load_file(estimate_);
    Trajectory truth;
    std::vector<std::int64_t> frames;
    bool row_numbers = false;
    if (std::filesystem::is_directory(truth_)) {
      truth = folder_truth(estimate, frames);
    } else {
      Loaded file = load_file(truth_);
      row_numbers = !estimate.timed && !file.timed;
      if (estimate.timed && !file.timed) give_stamps(file.poses, stamps_of(estimate.poses), truth_, estimate_);
      if (!estimate.timed) give_stamps(estimate.poses, stamps_of(file.poses), estimate_, truth_);
      truth = std::move(file.poses);
      frames = stamps_of(truth);
    }
    int from_pose = from_frame_;
    if (!estimate.timed) from_pose -= read_frames(estimate.poses, estimate_, static_cast<std::size_t>(from_frame_));
    // Row numbers are one "nanosecond" apart: only equal ones belong together.
    const std::int64_t tolerance = row_numbers ? 0 : kStampToleranceNs;
    TrajectoryEvaluation result = evaluate_trajectory(estimate.poses, truth, from_pose, tolerance, lengths());
    if (row_numbers) result.rpe_interval_s = NAN;
    std::printf("estimate   %s\ntruth      %s\n", estimate_.c_str(), truth_.c_str());
    print_evaluation(result);
    if (!result.segments.empty())
      note("warning: " + estimate_ + ": the motions between its " + data::counted(result.segments.size(), "segment") +
           " are unknown; errors of the whole trajectory include predictions of these motions, those of segments "
           "do not");
    std::optional<evaluation::StepJudgement> steps;
    if (steps_) {
      const std::int64_t first = result.per_pose.front().stamp_ns - tolerance;
      if (from_frame_ > 0) frames.erase(frames.begin(), std::lower_bound(frames.begin(), frames.end(), first));
      steps = evaluation::judge_steps(estimate.poses, truth, frames, step_limits_, tolerance);
      std::printf("\nsteps      %d right, %d wrong, %d lost of %d\n", steps->right, steps->wrong, steps->lost,
                  steps->steps());
    }
    if (!json_.empty())
      data::write_atomically(json_, report::evaluation_json(result, estimate_, truth_, command_line(), steps));
    return 0;
  }

 private:
  std::vector<double> lengths() const {
    if (lengths_.empty()) return kKittiLengths;
    std::vector<double> metres;
    for (const auto& word : data::split(lengths_, ",")) {
      char* end = nullptr;
      metres.push_back(std::strtod(word.c_str(), &end));
      if (*end != '\0' || !(metres.back() > 0 && std::isfinite(metres.back())))
        throw UsageError("--lengths " + lengths_ + ": expected metres, more than 0, for example 1,5,10");
    }
    return metres;
  }

  /// Ground truth of a sequence's folder and the stamps of its frames; gives these to the estimate if it has none.
  Trajectory folder_truth(Loaded& estimate, std::vector<std::int64_t>& frames) const {
    const Dataset dataset = open_dataset(truth_, dataset_);
    if (dataset.truth.empty()) {
      std::string notes;
      for (const std::string& note : dataset.notes) notes += "; " + note;
      throw DataError(truth_ + ": the sequence has no ground truth" + notes);
    }
    for (const auto& frame : dataset.frames) frames.push_back(frame.stamp_ns);
    if (!estimate.timed) give_stamps(estimate.poses, frames, estimate_, truth_);
    return dataset.truth;
  }

  std::string estimate_, truth_, json_, lengths_;
  DatasetOptions dataset_;
  int from_frame_ = 0;
  bool force_ = false, steps_ = false;
  evaluation::StepLimits step_limits_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_trajectory_command() { return std::make_unique<EvaluateTrajectoryCommand>(); }

}  // namespace quadedge::cli
