/// \file command_calibrate.cpp  quadedge calibrate: the calibration of a rig, learned from a recording with it.
#include <cstdio>

#include "cli/calibration_export.hpp"
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/rig_learning.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
#include "output/calibration_report.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class CalibrateCommand : public Command {
 public:
  CalibrateCommand()
      : Command("calibrate", "learn the calibration of a stereo rig from a recording of a moving camera",
                "  quadedge calibrate kitti/sequences/06 -o rig.yaml\n"
                "  quadedge calibrate --left left --right right --calibration camchain.yaml --fps 20 -o rig.yaml") {}
  void declare(Options& options) override {
    source_.declare_path(options, "folder of a recorded sequence");
    options.output(
        "-o,--output", output_,
        "file for the given or the learned calibration, whichever is better, in the program's own format, for "
        "--calibration");
    export_.declare(options);
    options.output("--json", json_, "write verdict, numbers and covariance");
    source_.declare_layout(options);
    options.number("--most-frames", limits_.frames,
                   "maximum number of frames to learn from, spread evenly over longer recordings");
    options.flag("--force", force_, "replace the files");
    options.flag("--quiet", quiet_, "hide progress and the table; the verdict remains");
    source_.declare(options);
    source_.declare_restarts(options);
  }
  int run() override {
    if (limits_.frames < 2)
      throw UsageError("--most-frames " + std::to_string(limits_.frames) + ": expected 2 or more");
    for (const std::string& file : {output_, json_}) report::check_output_file(file, force_);
    export_.check(force_);
    limits_.has_k3 = !export_.lacks_k3();
    const Dataset dataset = source_.open();
    const Interruption interruption;
    const DriveCalibration result = learn_rig(dataset, limits_, quiet_, interruption);
    if (!output_.empty()) write_calibration(output_, result.calibration);
    if (!json_.empty()) data::write_atomically(json_, report::calibration_json(result, command_line()));
    if (!quiet_) std::printf("%s\n", report::calibration_table(result).c_str());
    std::printf("%s\n", result.text().c_str());
    if (!output_.empty() && result.verdict != CalibrationVerdict::better)
      std::printf("%s holds the given calibration\n", output_.c_str());
    export_.write(result.calibration);
    return 0;
  }

 private:
  std::string output_, json_;
  CalibrationExport export_;
  SourceOptions source_;
  LearningLimits limits_;
  bool force_ = false, quiet_ = false;
};

}  // namespace

std::unique_ptr<Command> make_calibrate_command() { return std::make_unique<CalibrateCommand>(); }

}  // namespace quadedge::cli
