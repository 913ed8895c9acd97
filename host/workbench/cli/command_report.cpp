/// \file command_report.cpp  quadedge report: the page of a run or of a batch.
#include <filesystem>

#include "cli/command.hpp"
#include "cli/processes.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace fs = std::filesystem;
namespace {

class ReportCommand : public Command {
 public:
  ReportCommand()
      : Command("report", "make an HTML page of the results of a run or a batch",
                "  quadedge report results --csv tables") {}
  void declare(Options& options) override {
    options.positional("OUT", results_, "folder of a run or a batch");
    options.output("-o,--output", output_, "HTML file; default: OUT/report.html, which is overwritten");
    options.text("--csv", csv_, "also write each table as CSV", "DIR");
    options.flag("--force", force_, "replace FILE");
  }
  int run() override {
    const auto holds = [&](const char* name) { return fs::is_regular_file(fs::path(results_) / name); };
    if (!holds("summary.json") && !holds("report.json") && !holds("frames.csv")) {
      throw DataError(results_ +
                      ": no summary.json, report.json or frames.csv; expected the folder of a batch or of a run");
    }
    report::check_output_file(output_, force_);
    std::vector<std::string> arguments = {results_};
    if (!output_.empty()) arguments.insert(arguments.end(), {"--output", output_});
    if (!csv_.empty()) arguments.insert(arguments.end(), {"--csv", csv_});
    return make_page(arguments, Interruption());
  }

 private:
  std::string results_, output_, csv_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_report_command() { return std::make_unique<ReportCommand>(); }

}  // namespace quadedge::cli
