/// \file command_run.cpp  quadedge run: one recording, of a data set or of the user's cameras, to a trajectory.
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/rig_learning.hpp"
#include "cli/sequence_run.hpp"
#include "cli/source_options.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

constexpr int kDrawnOfPipe = 10;  ///< the frame that is drawn where the number of frames is unknown

class RunCommand : public Command {
 public:
  RunCommand()
      : Command("run", "track a recorded sequence or your own cameras and write the trajectory",
                "  quadedge run kitti/sequences/06 -o results_06\n"
                "  quadedge run --left left --right right --calibration camchain.yaml --fps 20 --device gpu") {}
  void declare(Options& options) override {
    source_.declare_path(options, "folder of a recorded sequence");
    options.text("-o,--output", run_.output, "output folder; default: quadedge_NAME in the current folder", "OUT");
    auto formats = dataset_formats();
    formats.insert(formats.begin(), "auto");
    options.choice("--format", dataset_.format, formats, "dataset layout; auto: recognised");
    options.text("--sequence", dataset_.sequence, "KITTI: name of the sequence if PATH holds several", "NAME");
    options.text("--frames", frames_, "frames from A up to but not including B; either may be omitted", "A:B");
    options.text("--name", name_, "name of the recording in the results; default: that of its files", "NAME");
    options.flag("--profile", run_.profile, "measure kernel times in a second pass");
    options.output("--trace", run_.trace, "write the stages of every frame in Chrome's trace format");
    options.number("--draw", run_.draw_every, "draw the edges and quads of every N-th frame; 0: of the middle frame");
    options.number("--thumbnails", run_.thumbnails, "number of quad thumbnails, spread evenly over the sequence");
    options.number("--min-tracked", min_tracked_, "exit with code 5 if fewer frames are tracked [percent]");
    options.flag("--loops", run_.loops,
                 "recognise places and close loops: trajectory_map.txt and loops.csv beside the odometry's files");
    options.output("--save-map", run_.saved_map,
                   "write the places of the recording for `quadedge localise`; implies --loops");
    options.flag(
        "--calibrate", calibrates_,
        "learn the calibration from the start of the recording, as `quadedge calibrate` does, and track all of "
        "it with the given or the learned one, whichever is better");
    options.flag("--force", run_.force, "replace results in OUT");
    options.flag("--quiet", run_.quiet, "hide progress; warnings and the summary remain");
    run_.points.declare(options);
    source_.declare(options);
    source_.declare_masks(options);
    source_.declare_restarts(options);
    method_.declare(options);
  }

  int run() override {
    if (run_.draw_every < 0) throw UsageError("--draw " + std::to_string(run_.draw_every) + ": expected 0 or more");
    if (run_.thumbnails < 0)
      throw UsageError("--thumbnails " + std::to_string(run_.thumbnails) + ": expected 0 (none) or more");
    if (!(min_tracked_ >= 0 && min_tracked_ <= 100)) throw UsageError("--min-tracked: expected 0 to 100 percent");
    method_.config();  // reports wrong options before data is read
    set_frames(dataset_, frames_);
    run_.restarts = source_.has_restarts();
    run_.loops = run_.loops || !run_.saved_map.empty();
    Dataset dataset = source_.open(dataset_);
    if (run_.profile && dataset.format == "pipe")
      throw UsageError("--profile reads the recording twice, which a pipe does not allow");
    if (calibrates_ && dataset.format == "pipe")
      throw UsageError(
          "--calibrate reads the recording twice, which a pipe does not allow; `quadedge calibrate -` reads a pipe "
          "once and writes a file for --calibration");
    if (!name_.empty()) dataset.name = name_;
    if (run_.output.empty()) run_.output = report::default_output_folder(dataset.name);
    const Interruption interruption;
    if (calibrates_) {
      report::refuse_results(run_.output, run_.force);
      calibrate(dataset, interruption);
    }
    FrameSource source(
        std::move(dataset), [&] { return interruption.signal() != 0; }, source_.words());
    if (run_.draw_every == 0 && run_.thumbnails == 0) {
      const int frames = source.facts().frames;
      run_.draw_frame = frames > 0 ? frames / 2 : kDrawnOfPipe;
    }
    const report::RunRecord record = run_sequence(source, method_, run_, interruption);
    print_run(record, run_.output);
    return exit_code(record, min_tracked_);
  }

 private:
  /// Tracks with the better calibration, and says so.
  void calibrate(Dataset& dataset, const Interruption& interruption) {
    constexpr int kEnoughPairs = 100;
    run_.learned = learn_rig(dataset, {0, kEnoughPairs}, run_.quiet, interruption);
    if (run_.learned->verdict == CalibrationVerdict::better)
      source_.replace_calibration(dataset, run_.learned->calibration);
    note(run_.learned->text());
  }

  std::string frames_, name_;
  bool calibrates_ = false;
  SourceOptions source_;
  DatasetOptions dataset_;
  SequenceRunOptions run_;
  double min_tracked_ = 50;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_run_command() { return std::make_unique<RunCommand>(); }

}  // namespace quadedge::cli
