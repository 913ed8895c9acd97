/// \file command_check.cpp  quadedge check: what is present, missing or wrong, before a long run.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "cli/calibration_check.hpp"
#include "cli/calibration_export.hpp"
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/source_options.hpp"
#include "data/find_sequences.hpp"
#include "data/text.hpp"
#include "output/output_folder.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class CheckCommand : public Command {
 public:
  CheckCommand()
      : Command("check",
                "read a whole sequence, or a folder of sequences, and report what is present, missing or wrong",
                "  quadedge check kitti/sequences/06\n"
                "  quadedge check eth3d\n"
                "  quadedge check flight --calibration camchain.yaml --write-calibration rig.yaml") {}
  void declare(Options& options) override {
    source_.declare_path(options, "folder of a sequence, or of many sequences");
    source_.declare_layout(options, false);
    options.output("--write-calibration", calibration_,
                   "write the cameras in the program's own format, for --calibration");
    export_.declare(options);
    options.flag("--force", force_, "replace files that exist");
    options.flag("--quiet", quiet_, "errors and warnings only");
    source_.declare(options);
    source_.declare_restarts(options);
  }
  int run() override {
    path_ = source_.path();
    if (!source_.is_given()) throw UsageError("nothing to check: expected PATH, or --left, --right and --calibration");
    report::check_output_file(calibration_, force_);
    export_.check(force_);
    if (!source_.is_own_camera() && is_tree()) return check_tree();
    const int code = print(check_recording());
    if (written_) export_.write(*written_);  // last, because a format may refuse the lens
    return code;
  }

 private:
  DatasetCheck check_recording() {
    RigEvidenceCollector evidence;
    const auto see = [&](const Dataset& dataset, const StereoPair& pair) { evidence.see(dataset, pair); };
    DatasetCheck check = source_.is_own_camera() ? check_stereo_source(source_.own_camera(), see)
                                                 : check_dataset(path_, source_.layout(), see);
    if (evidence.empty()) return check;
    evidence.finish(check);
    if (!check.errors.empty()) return check;
    const Dataset& dataset = evidence.dataset();
    written_ = dataset.calibration.value_or(pinhole_calibration(dataset.rig));
    if (!calibration_.empty()) write_calibration(calibration_, *written_);
    return check;
  }

  int print(const DatasetCheck& check) const {
    if (!quiet_) {
      for (const auto& fact : check.facts) std::printf("%s\n", fact.c_str());
    }
    for (const auto& warning : check.warnings) std::printf("warning: %s\n", warning.c_str());
    for (const auto& error : check.errors) std::fprintf(stderr, "error: %s\n", error.c_str());
    if (!quiet_)
      std::printf("%s, %s\n", data::counted(check.errors.size(), "error").c_str(),
                  data::counted(check.warnings.size(), "warning").c_str());
    return static_cast<int>(check.errors.empty() ? ExitCode::done : ExitCode::data);
  }

  /// Is PATH a folder of recordings instead of one? (A KITTI folder with a single sequence counts as that sequence.)
  bool is_tree() {
    std::error_code ignored;
    if (source_.has_layout() || !calibration_.empty() || !export_.empty() || source_.has_camera_options() ||
        !std::filesystem::is_directory(path_, ignored))
      return false;
    const auto members = data::find_recordings(path_, true);
    return members.size() > 1 || (members.size() == 1 && members[0].path != path_ && members[0].format != "kitti");
  }

  /// Checks every recording and pair below PATH.
  int check_tree() {
    int damaged = 0;
    StatusLine status(quiet_);
    const auto members = data::find_recordings(path_, true);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::string member = std::filesystem::path(members[i].path).lexically_relative(path_).string();
      if (status.due())
        status.show("reading " + member + "  " + std::to_string(i) + "/" + std::to_string(members.size()));
      const DatasetCheck check = check_dataset(members[i].path);
      damaged += check.errors.empty() ? 0 : 1;
      if (!quiet_) {
        std::printf("%-8s %s: %s\n", check.errors.empty() ? "ok" : "DAMAGED", member.c_str(),
                    data::one_line(check).c_str());
      }
      for (const auto& warning : check.warnings) std::printf("warning: %s: %s\n", member.c_str(), warning.c_str());
      for (const auto& error : check.errors) std::fprintf(stderr, "error: %s\n", error.c_str());
    }
    if (!quiet_) std::printf("%zu found, %d of them damaged\n", members.size(), damaged);
    return static_cast<int>(damaged == 0 ? ExitCode::done : ExitCode::data);
  }

  std::string path_, calibration_;
  CalibrationExport export_;
  std::optional<StereoCalibration> written_;  ///< of a recording without errors
  SourceOptions source_;
  bool force_ = false, quiet_ = false;
};

}  // namespace

std::unique_ptr<Command> make_check_command() { return std::make_unique<CheckCommand>(); }

}  // namespace quadedge::cli
