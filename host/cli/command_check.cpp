/// \file command_check.cpp  quadedge check: what is there, what is missing or wrong, before a long run.
#include <cstdio>

#include "cli/command.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class CheckCommand : public Command {
 public:
  std::string name() const override { return "check"; }
  std::string about() const override { return "read all of a sequence and say what is there, missing or wrong"; }
  std::string examples() const override {
    return "  quadedge check kitti/sequences/06\n"
           "  quadedge check kitti --sequence 01";
  }
  void declare(Options& options) override {
    options.positional("PATH", path_, "folder of the sequence");
    auto formats = dataset_formats();
    formats.insert(formats.begin(), "auto");
    options.choice("--format", options_.format, formats, "layout of the data; auto recognises it");
    options.text("--sequence", options_.sequence, "KITTI: which sequence, when PATH holds several", "NAME");
    options.flag("--quiet", quiet_, "errors only");
  }
  int run() override {
    const DatasetCheck check = check_dataset(path_, options_);
    if (!quiet_) {
      for (const auto& fact : check.facts) std::printf("%s\n", fact.c_str());
      for (const auto& warning : check.warnings) std::printf("warning: %s\n", warning.c_str());
    }
    for (const auto& error : check.errors) std::fprintf(stderr, "error: %s\n", error.c_str());
    if (!quiet_) std::printf("%zu errors, %zu warnings\n", check.errors.size(), check.warnings.size());
    return static_cast<int>(check.errors.empty() ? ExitCode::done : ExitCode::data);
  }

 private:
  std::string path_;
  DatasetOptions options_;
  bool quiet_ = false;
};

}  // namespace

std::unique_ptr<Command> make_check_command() { return std::make_unique<CheckCommand>(); }

}  // namespace quadedge::cli
