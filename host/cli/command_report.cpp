/// \file command_report.cpp  quadedge report: the page of a run, of a batch or of an evaluation of the matching.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/processes.hpp"
#include "data/atomic_file.hpp"
#include "output/comparison.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace fs = std::filesystem;
namespace {

class ReportCommand : public Command {
 public:
  ReportCommand()
      : Command("report", "make an HTML page of the results of a run, a batch or a matching evaluation",
                "  quadedge report results --latex tables --figures figures\n"
                "  quadedge report results --baseline yesterday --peer ORB-SLAM3=trajectories/orbslam3 -o "
                "comparison.html") {}
  void declare(Options& options) override {
    options.positional("OUT", results_,
                       "folder of a run or a batch, or a file of `python -m quadedge.matching --json`");
    options.text("--baseline", baseline_, "another batch; the page shows the differences from it", "OTHER");
    options.repeated("--peer", peers_,
                     "left-camera trajectories of another system, FOLDER/SEQUENCE.txt (TUM); repeatable",
                     "NAME=FOLDER");
    options.output(
        "-o,--output", output_,
        "HTML file; default: OUT/report.html, or OUT with .html instead of .json; the default is overwritten");
    options.text("--csv", csv_, "also write each table as CSV", "DIR");
    options.text("--latex", latex_, "also write each table for LaTeX (booktabs)", "DIR");
    options.text("--figures", figures_, "also write each figure as SVG and PDF", "DIR");
    options.flag("--force", force_, "replace FILE");
  }
  int run() override {
    const bool is_batch = fs::is_regular_file(fs::path(results_) / "summary.json");
    const bool is_file = fs::is_regular_file(results_);
    const auto holds = [&](const char* name) { return fs::is_regular_file(fs::path(results_) / name); };
    if (!is_batch && !is_file && !holds("report.json") && !holds("frames.csv")) {
      throw DataError(results_ +
                      ": no summary.json, report.json or frames.csv; expected the folder of a batch or of a run, "
                      "or a file of `python -m quadedge.matching --json`");
    }
    const auto peers = named_peers();
    const bool compares = !peers.empty() || !baseline_.empty();
    if (compares && !is_batch) throw UsageError("--baseline and --peer need a batch, and " + results_ + " is not one");
    report::check_output_file(output_, force_);
    const fs::path page = output_.empty() ? default_page(is_file) : fs::path(output_);
    std::vector<std::string> arguments = {results_, "--output", page.string()};
    if (compares) {
      const fs::path figures = output_.empty() ? fs::path(results_) / "comparison.json" : data_beside(page);
      data::write_atomically(figures.string(), report::comparison_json(results_, baseline_, peers, command_line()));
      arguments.insert(arguments.end(), {"--comparison", figures.string()});
    }
    for (const auto& [option, folder] : {std::pair("--csv", &csv_), {"--latex", &latex_}, {"--figures", &figures_}}) {
      if (!folder->empty()) arguments.insert(arguments.end(), {option, *folder});
    }
    return make_page(arguments, Interruption());
  }

 private:
  fs::path default_page(bool is_file) const {
    return is_file ? fs::path(results_).replace_extension(".html") : fs::path(results_) / "report.html";
  }

  /// comparison.html is made from comparison.json. \throws UsageError for a page of that name.
  fs::path data_beside(const fs::path& page) const {
    const fs::path figures = fs::path(page).replace_extension(".json");
    if (figures == page)
      throw UsageError("--output " + output_ + ": this file will hold the figures; expected a name ending in .html");
    report::check_output_file(figures.string(), force_);
    return figures;
  }

  std::vector<report::Peer> named_peers() const {
    std::vector<report::Peer> peers;
    for (const auto& text : peers_) {
      const report::Peer peer = named_peer(text);
      const auto same = [&](const report::Peer& other) { return other.name == peer.name; };
      if (peer.name == "QuadEdge" || peer.name == "baseline" || std::any_of(peers.begin(), peers.end(), same))
        throw UsageError("--peer " + text + ": this name is already used");
      peers.push_back(peer);
    }
    return peers;
  }

  static report::Peer named_peer(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) throw UsageError("--peer " + text + ": expected NAME=FOLDER");
    report::Peer peer{text.substr(0, equals), text.substr(equals + 1)};
    std::error_code ignored;
    if (!fs::is_directory(peer.folder, ignored))
      throw DataError("--peer " + text + ": " + peer.folder + " is not a folder");
    return peer;
  }

  std::string results_, baseline_, output_, csv_, latex_, figures_;
  std::vector<std::string> peers_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_report_command() { return std::make_unique<ReportCommand>(); }

}  // namespace quadedge::cli
