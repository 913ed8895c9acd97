/// \file command_synth.cpp  quadedge synth: the rendered sequence on disk, in the ETH3D SLAM layout with depth.
#include <cstdio>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
#include "data/sequence_writer.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class SynthCommand : public Command {
 public:
  SynthCommand()
      : Command("synth", "write the rendered sequence to disk (ETH3D SLAM layout, with depth and poses)",
                "  quadedge synth room60 --scene room --frames 60\n"
                "  quadedge synth blurred --scene cables --frames 4 --size 320x200 --blur 3\n"
                "  quadedge synth fisheye --lens equidistant --right-rotation 0,2,0") {}
  void declare(Options& options) override {
    options.positional("OUT", output_, "folder for the sequence");
    options.number("--seed", scene_.seed, "seed of textures and camera noise");
    options.flag("--force", force_, "replace a sequence in OUT");
    options.flag("--quiet", quiet_, "hide progress and the summary");
    declare_scene(options, scene_, texts_);
  }
  int run() override {
    set_texts(scene_, texts_);
    const SyntheticSequence sequence(scene_);
    clear_place();
    Progress progress(quiet_, "frames");
    write_eth3d_slam(output_, sequence, [&](int done, int all) { progress.update("rendering", done, all); });
    if (!quiet_) {
      std::printf("%s of %d x %d px in %s; largest disparity %.1f px\n",
                  data::counted(sequence.frames(), "frame").c_str(), sequence.rig().left.width,
                  sequence.rig().left.height, output_.c_str(), sequence.rig().max_disparity);
    }
    return 0;
  }

 private:
  /// Refuses a folder that holds a sequence; with --force removes that sequence and nothing else.
  void clear_place() const {
    const std::filesystem::path folder(output_);
    std::error_code error;
    for (const char* name : {"rgb.txt", "calibration.txt", "calibration2.txt", "calibration.yaml", "extrinsics_1_2.txt",
                             "groundtruth.txt", "rgb", "rgb2", "depth", "depth2"}) {
      if (!std::filesystem::exists(folder / name, error)) continue;
      if (!force_)
        throw UsageError(output_ + ": the folder holds a sequence (" + name +
                         "); choose another folder, or replace it with --force");
      data::remove_all(folder / name);
    }
  }

  std::string output_;
  SceneTexts texts_;
  SyntheticOptions scene_;
  bool force_ = false, quiet_ = false;
};

}  // namespace

std::unique_ptr<Command> make_synth_command() { return std::make_unique<SynthCommand>(); }

}  // namespace quadedge::cli
