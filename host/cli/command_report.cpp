/// \file command_report.cpp  quadedge report: the HTML page of a batch.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/output_folder.hpp"
#include "data/atomic_file.hpp"
#include "quadedge/error.hpp"
#include "report/batch_report.hpp"

namespace quadedge::cli {
namespace {

class ReportCommand : public Command {
 public:
  std::string name() const override { return "report"; }
  std::string about() const override { return "draw the results of a batch on one HTML page"; }
  std::string examples() const override {
    return "  quadedge report results\n"
           "  quadedge report results --baseline yesterday --peer ORB-SLAM3=trajectories/orbslam3 -o comparison.html";
  }
  void declare(Options& options) override {
    options.positional("OUT", batch_, "folder of a batch");
    options.text("--baseline", baseline_, "another batch; differences to it stand beside each figure", "OTHER");
    options.repeated("--peer", peers_,
                     "another system's trajectories of the left camera, FOLDER/SEQUENCE.txt (TUM); repeatable",
                     "NAME=FOLDER");
    options.text("-o,--output", output_, "file of the page; default: OUT/report.html, which is replaced", "FILE");
    options.flag("--force", force_, "replace FILE");
  }
  int run() override {
    std::vector<report::Peer> peers;
    for (const auto& text : peers_) peers.push_back(peer(text));
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const auto same = [&](const report::Peer& other) { return other.name == peers[i].name; };
      const auto before = peers.begin() + static_cast<std::ptrdiff_t>(i);
      if (same({"QuadEdge", ""}) || same({"baseline", ""}) || std::any_of(peers.begin(), before, same)) {
        throw UsageError("--peer " + peers_[i] + ": the name is taken");
      }
    }
    check_output_file(output_, force_);
    const std::string file = output_.empty() ? (std::filesystem::path(batch_) / "report.html").string() : output_;
    data::write_atomically(file, report::batch_report_html(batch_, baseline_, peers));
    std::printf("%s\n", file.c_str());
    return 0;
  }

 private:
  static report::Peer peer(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) throw UsageError("--peer " + text + ": expected NAME=FOLDER");
    report::Peer peer{text.substr(0, equals), text.substr(equals + 1)};
    std::error_code ignored;
    if (!std::filesystem::is_directory(peer.folder, ignored))
      throw DataError("--peer " + text + ": " + peer.folder + " is no folder");
    return peer;
  }

  std::string batch_, baseline_, output_;
  std::vector<std::string> peers_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_report_command() { return std::make_unique<ReportCommand>(); }

}  // namespace quadedge::cli
