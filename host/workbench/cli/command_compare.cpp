/// \file command_compare.cpp  quadedge compare: every kernel variant on the same input, and the best ones kept for this
/// device.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "benchmark/latency.hpp"
#include "benchmark/variant_comparison.hpp"
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/method_options.hpp"
#include "common/printed.hpp"
#include "data/atomic_file.hpp"
#include "geometry/disparity_range.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

void print_number(double value, const char* format, const char* missing) {
  if (std::isfinite(value)) {
    std::printf(format, value);
  } else {
    std::printf("%s", missing);
  }
}

void print_stage(const bench::StageResult& stage) {
  for (const auto& variant : stage.variants) {
    std::printf("%-20s %-10s %-8s", stage.stage.c_str(), variant.name.c_str(), variant.is_default ? "default" : "");
    print_number(variant.median_ms, " %9.3f ms", "         -   ");
    print_number(variant.p10_ms, " %9.3f", "         -");
    print_number(variant.p90_ms, " %9.3f", "         -");
    print_number(variant.ratio_to_default, " %7.2f", "       -");
    print_number(variant.ratio_p90, " %7.2f", "       -");
    const char* mark = !variant.runs         ? "  CANNOT RUN: "
                       : !variant.agrees     ? "  REFUSED: "
                       : variant.why.empty() ? ""
                                             : "  ";
    std::printf("%s%s\n", mark, variant.why.c_str());
  }
  std::fflush(stdout);
}

class CompareCommand : public Command {
 public:
  CompareCommand()
      : Command("compare", "check and measure every kernel variant of every stage on the same input",
                "  quadedge compare --stage edge_detection") {}
  void declare(Options& options) override {
    options.text("--stage", stage_, "compare this stage only (`quadedge variants` lists them)", "STAGE");
    options.text("--size", size_, "size of the rendered images [px]; default 942x489", "WxH");
    options.number("--edges", edges_, "choose edges.threshold for this number of edges per image; 0: as configured");
    options.number("--repetitions", repetitions_, "measurements per variant, interleaved");
    options.flag("--save", save_, "save the fastest variants for this device, for `run`, `demo` and `bench`");
    options.output("--json", json_, "write all figures");
    options.flag("--force", force_, "overwrite an existing file");
    options.flag("--quiet", quiet_, "hide progress");
    method_.declare(options);
  }

  int run() override {
    const auto stages = chosen_stages();
    if (edges_ < 0) throw UsageError("--edges " + std::to_string(edges_) + ": expected 0 or more");
    if (repetitions_ < 1) throw UsageError("--repetitions " + std::to_string(repetitions_) + ": expected 1 or more");
    Config config = method_.config();
    report::check_output_file(json_, force_);
    auto device = std::make_shared<Device>(method_.open_device(true));
    if (device->is_reference()) throw UsageError("the reference device has no kernel variants");
    const DeviceInfo info = device->info();
    const std::string file = bench::saved_variants_path(info);
    if (save_ && file.empty()) throw UsageError("--save: neither XDG_CONFIG_HOME nor HOME is set");

    SyntheticOptions scene;
    scene.frames = 2;
    set_size(scene, size_);
    FrameSource source(scene);
    const auto first = source.next(), second = source.next();
    config = with_disparity_range(config, source.rig());
    if (edges_ > 0) config.edges.threshold = bench::threshold_for_edges(*first, edges_, *device, config);
    std::printf("%s\n\n%-20s %-10s %-8s %12s %9s %9s %7s %7s\n", info.name.c_str(), "stage", "variant", "", "median",
                "p10", "p90", "ratio", "p90");

    const auto same_device = [&](bool has_failed) {
      if (has_failed) device = std::make_shared<Device>(method_.open_device(true));
      return device;
    };
    const bench::VariantInput input{source.rig(), *first, *second, config, same_device, repetitions_};
    StatusLine status(quiet_);
    std::vector<bench::StageResult> results;
    for (const auto& stage : stages) {
      results.push_back(bench::compare_variants(stage, input, [&](const std::string& what) {
        if (status.due()) status.show(what);
      }));
      print_stage(results.back());
    }
    if (!json_.empty()) data::write_atomically(json_, bench::comparison_json(info, results, command_line()));
    if (save_) save(file, info, results);
    return exit_code(results);
  }

 private:
  std::vector<std::string> chosen_stages() const {
    auto stages = bench::stages_with_variants();
    if (stage_.empty()) return stages;
    if (std::find(stages.begin(), stages.end(), stage_) == stages.end())
      throw UsageError("--stage " + stage_ + ": no such stage with variants; there are: " + joined(stages, " "));
    return {stage_};
  }

  /// Variants saved for other stages are kept, unless the file is for another device or program; it is then replaced.
  void save(const std::string& file, const DeviceInfo& info, const std::vector<bench::StageResult>& results) const {
    std::map<std::string, std::string> variants;
    try {
      variants = bench::read_variants_file(file, info);
    } catch (const UsageError& error) {
      note(std::string("warning: replacing ") + error.what());
    }
    for (const auto& stage : results) {
      if (!stage.best().empty()) variants[stage.stage] = stage.best();
    }
    bench::write_variants_file(file, info, variants);
    std::printf("\nsaved in %s\n", file.c_str());
  }

  /// A variant with a different result is a bug.
  static int exit_code(const std::vector<bench::StageResult>& results) {
    for (const auto& stage : results) {
      for (const auto& variant : stage.variants) {
        if (variant.runs && !variant.agrees) return static_cast<int>(ExitCode::internal);
      }
    }
    return static_cast<int>(ExitCode::done);
  }

  std::string stage_, size_, json_;
  int edges_ = kBenchEdges, repetitions_ = 9;
  bool save_ = false, force_ = false, quiet_ = false;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command() { return std::make_unique<CompareCommand>(); }

}  // namespace quadedge::cli
