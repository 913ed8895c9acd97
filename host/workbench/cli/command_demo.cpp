/// \file command_demo.cpp  quadedge demo: the built-in sequence, run and evaluated.
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/sequence_run.hpp"
#include "cli/source_options.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class DemoCommand : public Command {
 public:
  DemoCommand()
      : Command("demo", "track the built-in rendered sequence and compare with its exact poses",
                "  quadedge demo\n"
                "  quadedge demo --scene cables --frames 20 -o cables --force") {
    run_.output = "quadedge_demo";
  }
  void declare(Options& options) override {
    options.text("-o,--output", run_.output, "folder for the results", "OUT");
    options.flag("--profile", run_.profile, "measure kernel times in a second pass");
    options.output("--trace", run_.trace, "write the stages of every frame in Chrome's trace format");
    options.number("--draw", run_.draw_every,
                   "pictures of the edges and quads of every N-th frame; 0: of the middle frame");
    options.number("--min-tracked", min_tracked_, "fewer tracked frames end with exit code 5 [percent]");
    options.flag("--force", run_.force, "replace the results in OUT");
    options.flag("--quiet", run_.quiet, "hide progress; warnings and the summary remain");
    options.number("--scene-seed", scene_.seed, "of textures, cable shapes and camera noise");
    declare_scene(options, scene_, texts_);
    method_.assume_exact_rig();
    method_.declare(options);
  }

  int run() override {
    if (run_.draw_every < 0) throw UsageError("--draw " + std::to_string(run_.draw_every) + ": expected 0 or more");
    if (!(min_tracked_ >= 0 && min_tracked_ <= 100)) throw UsageError("--min-tracked: expected 0 to 100 percent");
    method_.config();
    set_texts(scene_, texts_);
    const Interruption interruption;
    RenderingStatus rendering(run_.quiet, &interruption);
    FrameSource source(scene_, [&](const data::RenderedFrames& frames) { return rendering.show(frames); });
    if (run_.draw_every == 0) run_.draw_frame = scene_.frames / 2;
    const report::RunRecord record = run_sequence(source, method_, run_, interruption);
    print_run(record, run_.output);
    return exit_code(record, min_tracked_);
  }

 private:
  SyntheticOptions scene_;
  SceneTexts texts_;
  SequenceRunOptions run_;
  double min_tracked_ = 50;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_demo_command() { return std::make_unique<DemoCommand>(); }

}  // namespace quadedge::cli
