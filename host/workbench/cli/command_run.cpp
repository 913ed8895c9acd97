/// \file command_run.cpp  quadedge run and demo: one recording, of a data set, of the user's cameras or built in, to a
/// trajectory.
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

/// What both commands have in common.
class TrackingCommand : public Command {
 protected:
  using Command::Command;

  void declare_results(Options& options) {
    options.number("--draw", run_.draw_every, "draw the edges and quads of every N-th frame; 0: of the middle frame");
    options.number("--min-tracked", min_tracked_, "exit with code 5 if fewer frames are tracked [percent]");
    options.flag("--force", run_.force, "replace results in OUT");
    options.flag("--quiet", run_.quiet, "hide progress; warnings and the summary remain");
  }

  /// Reports wrong options before data is read.
  void check() const {
    if (run_.draw_every < 0) throw UsageError("--draw " + std::to_string(run_.draw_every) + ": expected 0 or more");
    if (!(min_tracked_ >= 0 && min_tracked_ <= 100)) throw UsageError("--min-tracked: expected 0 to 100 percent");
    method_.config();
  }

  /// \returns the exit code
  int track(FrameSource& source, const Interruption& interruption) {
    if (run_.draw_every == 0 && run_.thumbnails == 0) {
      const int frames = source.facts().frames;
      run_.draw_frame = frames > 0 ? frames / 2 : kDrawnOfPipe;
    }
    const report::RunRecord record = run_sequence(source, method_, run_, interruption);
    print_run(record, run_.output);
    return exit_code(record, min_tracked_);
  }

  SequenceRunOptions run_;
  MethodOptions method_;

 private:
  double min_tracked_ = 50;
};

class RunCommand : public TrackingCommand {
 public:
  RunCommand()
      : TrackingCommand("run", "track a recorded sequence or your own cameras and write the trajectory",
                        "  quadedge run kitti/sequences/06 -o results_06\n"
                        "  quadedge run --left left --right right --calibration camchain.yaml --fps 20 --device gpu") {}
  void declare(Options& options) override {
    source_.declare_path(options, "folder of a recorded sequence");
    options.text("-o,--output", run_.output, "output folder; default: quadedge_NAME in the current folder", "OUT");
    source_.declare_layout(options);
    options.text("--name", name_, "name of the recording in the results; default: that of its files", "NAME");
    options.number("--thumbnails", run_.thumbnails, "number of quad thumbnails, spread evenly over the sequence");
    options.flag("--loops", run_.loops,
                 "recognise places and close loops: trajectory_map.txt and loops.csv beside the odometry's files");
    options.output("--save-map", run_.saved_map,
                   "write the places of the recording for `quadedge localise`; implies --loops");
    options.flag(
        "--calibrate", calibrates_,
        "learn the calibration from the start of the recording, as `quadedge calibrate` does, and track all of "
        "it with the given or the learned one, whichever is better");
    declare_results(options);
    run_.points.declare(options);
    source_.declare(options);
    source_.declare_masks(options);
    source_.declare_restarts(options);
    method_.declare(options);
  }

  int run() override {
    check();
    if (run_.thumbnails < 0)
      throw UsageError("--thumbnails " + std::to_string(run_.thumbnails) + ": expected 0 (none) or more");
    run_.restarts = source_.has_restarts();
    run_.loops = run_.loops || !run_.saved_map.empty();
    Dataset dataset = source_.open();
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
    return track(source, interruption);
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

  std::string name_;
  bool calibrates_ = false;
  SourceOptions source_;
};

class DemoCommand : public TrackingCommand {
 public:
  DemoCommand()
      : TrackingCommand("demo", "track the built-in rendered sequence and compare with its exact poses",
                        "  quadedge demo\n"
                        "  quadedge demo --scene cables --frames 20 -o cables --force") {
    run_.output = "quadedge_demo";
  }
  void declare(Options& options) override {
    options.text("-o,--output", run_.output, "folder for the results", "OUT");
    declare_results(options);
    options.number("--scene-seed", scene_.seed, "of textures, cable shapes and camera noise");
    declare_scene(options, scene_, texts_);
    method_.assume_exact_rig();
    method_.declare(options);
  }

  int run() override {
    check();
    set_texts(scene_, texts_);
    const Interruption interruption;
    FrameSource source(scene_, run_.quiet, &interruption);
    return track(source, interruption);
  }

 private:
  SyntheticOptions scene_;
  SceneTexts texts_;
};

}  // namespace

std::unique_ptr<Command> make_run_command() { return std::make_unique<RunCommand>(); }
std::unique_ptr<Command> make_demo_command() { return std::make_unique<DemoCommand>(); }

}  // namespace quadedge::cli
