/// \file command_localise.cpp  quadedge localise: frames of a recording in a map of another.
#include <cstdio>

#include "benchmark/variant_comparison.hpp"
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/method_options.hpp"
#include "cli/processes.hpp"
#include "cli/sequence_run.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "data/trajectory_rows.hpp"
#include "output/config_toml.hpp"
#include "output/json.hpp"
#include "output/output_folder.hpp"
#include "output/result_rows.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class LocaliseCommand : public Command {
 public:
  LocaliseCommand()
      : Command("localise", "locate the frames of a recording in the map of another one",
                "  quadedge run V1_01_easy --save-map v1.map\n"
                "  quadedge localise v1.map V1_02_medium -o located") {}
  void declare(Options& options) override {
    options.positional("MAP", map_, "file of `quadedge run --save-map`");
    source_.declare_path(options, "folder of a recorded sequence, by these or other cameras");
    options.text("-o,--output", output_, "output folder; default: quadedge_NAME in the current folder", "OUT");
    source_.declare_layout(options);
    options.flag("--follow", follow_, "search near a prediction from the two frames before, if these were located");
    options.number("--min-tracked", min_located_, "exit with code 5 if fewer frames are located [percent]");
    options.flag("--force", force_, "replace results in OUT");
    options.flag("--quiet", quiet_, "hide progress; warnings and the summary remain");
    source_.declare(options);
    source_.declare_masks(options);
    method_.declare(options);
  }

  int run() override {
    if (!(min_located_ >= 0 && min_located_ <= 100)) throw UsageError("--min-tracked: expected 0 to 100 percent");
    report::LocalisationRecord record;
    record.config = method_.config();
    const SavedMap map = read_map(map_);
    Dataset dataset = source_.open();
    if (output_.empty()) output_ = report::default_output_folder(dataset.name);
    record.command = command_line();
    record.map_file = map_;
    record.key_rigs = map.key_rigs();
    report::check_beside_results({}, output_, dataset.path);
    const report::FolderLock lock = report::prepare_output_folder(output_, force_);
    const Interruption interruption;
    FrameSource source(
        std::move(dataset), [&] { return interruption.signal() != 0; }, source_.words());
    record.input = source.facts();
    try {
      locate(map, source, interruption, record);
    } catch (const Error& error) {
      if (record.frames.empty()) throw;
      record.ended_early = error.what();
      end_with_error(error, record.frames.size(), output_, {[&] { write_results(source, record); }});
    }
    if (interruption.signal() != 0) record.ended_early = "interrupted";
    write_results(source, record);
    print(record);
    if (interruption.signal() != 0) interruption.end_process();
    return exit_code("located", record.located(), record.frames.size(), min_located_,
                     report::lost_reasons(record.frames));
  }

 private:
  void locate(const SavedMap& map, FrameSource& source, const Interruption& interruption,
              report::LocalisationRecord& record) {
    Device device = method_.open_device();
    bench::add_saved_variants(device, record.config);
    record.device = device.info();
    Localiser localiser(map, source.rig(), device, record.config, follow_);
    data::write_atomically(output_ + "/config.toml", report::config_toml(record.config, method_.device_choice()));
    report::LocationFiles files(output_);
    Progress progress(quiet_, "frames");
    int lost = 0;
    while (const auto frame = source.next()) {
      const Localisation located = localiser.locate(frame->view());
      const int number = static_cast<int>(record.frames.size());
      files.add(number, located);
      for (const Warning& warning : located.warnings)
        note("warning: frame " + std::to_string(number) + ": " + warning.text);
      lost += located.map_from_left ? 0 : 1;
      record.frames.push_back(located);
      progress.update(record.input.name + " frame", number + 1, record.input.frames, std::to_string(lost) + " lost");
      if (interruption.signal() != 0) break;
    }
  }

  /// Compares with the ground truth, if any, up to a rigid motion, and writes localisation.json.
  void write_results(const FrameSource& source, report::LocalisationRecord& record) const {
    if (!source.dataset().truth.empty() && record.located() > 0) {
      Trajectory located;
      for (const Localisation& frame : record.frames)
        if (frame.map_from_left) located.push_back({frame.stamp_ns, *frame.map_from_left});
      try {
        record.truth_file = source.dataset().truth_file;
        record.accuracy = evaluate_trajectory(located, source.dataset().truth);
      } catch (const DataError& error) {
        note(std::string("warning: no accuracy: ") + error.what());
      }
    }
    data::write_atomically(output_ + "/localisation.json", report::localisation_json(record));
  }

  void print(const report::LocalisationRecord& record) const {
    std::printf("map        %s, %s\n", map_.c_str(), data::counted(record.key_rigs, "keyframe").c_str());
    std::printf("sequence   %s (%s)\n", visible(record.input.name).c_str(), record.input.format.c_str());
    std::printf("located    %d of %s\n", record.located(), data::counted(record.frames.size(), "frame").c_str());
    const std::string lost = report::lost_reasons(record.frames);
    if (!lost.empty()) std::printf("lost       %s\n", lost.c_str());
    std::printf("latency    median %.1f ms\n", report::median_latency_ms(record.frames));
    if (record.accuracy) print_evaluation(*record.accuracy);
    std::printf("\nresults in %s\n", output_.c_str());
  }

  std::string map_, output_;
  SourceOptions source_;
  bool follow_ = false, force_ = false, quiet_ = false;
  double min_located_ = 50;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_localise_command() { return std::make_unique<LocaliseCommand>(); }

}  // namespace quadedge::cli
