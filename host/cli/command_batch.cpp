/// \file command_batch.cpp  quadedge batch: many sequences, their results and one summary.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/batch.hpp"
#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/processes.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "report/batch_summary.hpp"
#include "report/config_toml.hpp"
#include "report/output_folder.hpp"

namespace quadedge::cli {
namespace fs = std::filesystem;
namespace {

class BatchCommand : public Command {
 public:
  BatchCommand()
      : Command("batch", "track many sequences, each in its own process, and summarise the results",
                "  quadedge batch eth3d/training -o results\n"
                "  quadedge batch sequences.txt -o results --device gpu --jobs 2") {
    batch_.output = "quadedge_batch";
  }
  void declare(Options& options) override {
    options.positional("ROOT|LIST", input_,
                       "folder with sequences at any depth, or a file with one folder, or one camera source, per line");
    options.text("-o,--output", batch_.output, "output folder; default: quadedge_batch in the current folder", "OUT");
    options.number("--jobs", batch_.jobs, "number of sequences tracked in parallel; 0: chosen by device");
    options.flag("--timing", batch_.timing,
                 "measure latencies: track one sequence at a time, and repeat those that ran in parallel");
    options.flag("--profile", batch_.profile, "measure kernel times of every sequence in a second pass");
    options.flag("--loops", batch_.loops, "recognise places and close loops in every sequence");
    options.number("--draw", batch_.draw_every, "draw the edges and quads of every N-th frame");
    options.number("--min-tracked", batch_.min_tracked,
                   "exit with code 5 if fewer frames of a sequence are tracked [percent]");
    options.flag("--force", batch_.force, "repeat finished sequences");
    options.flag("--quiet", batch_.quiet, "hide progress; warnings and the summary remain");
    options.group("Single steps of a batch, for schedulers");
    options.flag("--list", list_, "print name and folder of every sequence; track none");
    options.text("--only", only_, "track only this sequence, without a summary; several processes may share OUT",
                 "NAME");
    options.flag("--gather", gather_, "track nothing; summarise the results that exist");
    method_.declare(options);
  }

  int run() override {
    if (batch_.jobs < 0)
      throw UsageError("--jobs " + std::to_string(batch_.jobs) + ": expected 0 (chosen by device) or more");
    if (batch_.timing && batch_.jobs > 1)
      throw UsageError("--timing and --jobs " + std::to_string(batch_.jobs) + " exclude one another");
    if (batch_.draw_every < 0)
      throw UsageError("--draw " + std::to_string(batch_.draw_every) + ": expected 0 (none) or more");
    if (!(batch_.min_tracked >= 0 && batch_.min_tracked <= 100))
      throw UsageError("--min-tracked: expected 0 to 100 percent");
    if (list_ + gather_ + !only_.empty() > 1) throw UsageError("--list, --only and --gather exclude one another");
    method_.config();  // reports wrong options before data is read
    const auto sequences = data::find_sequences(input_);
    if (list_) return print_list(sequences);
    if (!only_.empty()) return run_one(sequences);
    return gather_ ? summarise(sequences, Interruption()) : run_all(sequences);
  }

 private:
  static int print_list(const std::vector<data::FoundSequence>& sequences) {
    for (const auto& sequence : sequences) std::printf("%s\t%s\n", sequence.name.c_str(), sequence.path.c_str());
    return 0;
  }

  fs::path output() const { return batch_.output; }

  /// The configuration that all runs read.
  void write_config() const {
    data::write_atomically((output() / "config.toml").string(),
                           report::config_toml(method_.config(), method_.device_choice()));
  }

  /// The plan of some sequences, for the device that will run them.
  std::vector<BatchMember> plan(const std::vector<data::FoundSequence>& sequences) {
    const DeviceInfo device = method_.open_device().info();  // a missing device ends the batch here, not in every run
    if (batch_.jobs == 0) batch_.jobs = default_jobs(device, batch_);
    return plan_batch(sequences, method_, device, batch_);
  }

  int run_all(const std::vector<data::FoundSequence>& sequences) {
    data::make_folder(output() / "sequences");
    const report::FolderLock lock((output() / ".lock").string(), false, batch_.output);
    const Interruption interruption;
    write_config();
    const auto members = plan(sequences);
    data::remove_all(output() / "unfinished");  // of a batch that was killed; only while the lock is held alone
    note_progress(members);
    const bool complete =
        std::all_of(members.begin(), members.end(), [](const auto& member) { return member.finished; });
    if (!complete) remove_summary();  // it would not match the new results
    const auto before =
        std::count_if(members.begin(), members.end(), [](const auto& member) { return member.finished; });
    const auto finished = before + run_batch(members, method_, batch_, interruption);
    data::remove_all(output() / "unfinished");
    if (interruption.signal() != 0) {
      note("interrupted; " + std::to_string(finished) + " of " + data::counted(members.size(), "sequence") +
           " finished, results in " + (output() / "sequences").string() + "; repeat the command to go on");
      interruption.end_process();
    }
    return summarise(sequences, interruption);
  }

  int run_one(const std::vector<data::FoundSequence>& sequences) {
    const auto found =
        std::find_if(sequences.begin(), sequences.end(), [&](const auto& sequence) { return sequence.name == only_; });
    if (found == sequences.end())
      throw UsageError("--only " + only_ + ": " + input_ + " has no such sequence; --list prints all");
    data::make_folder(output() / "sequences");
    const report::FolderLock lock((output() / ".lock").string(), true, batch_.output);
    const Interruption interruption;
    write_config();
    run_batch(plan({*found}), method_, batch_, interruption);
    if (interruption.signal() != 0) interruption.end_process();
    const auto row = report::read_summary_row(report::member_folder(batch_.output, only_), only_, batch_.min_tracked);
    if (row.member.exit_code != 0)
      std::fprintf(stderr, "quadedge: %s: %s\n", only_.c_str(), row.member.message.c_str());
    return row.member.exit_code;
  }

  void remove_summary() const {
    for (const char* name : {"summary.json", "summary.md", "report.html"}) data::remove_all(output() / name);
  }

  void note_progress(const std::vector<BatchMember>& members) const {
    const auto finished =
        std::count_if(members.begin(), members.end(), [](const auto& member) { return member.finished; });
    std::string sentence =
        data::counted(members.size(), "sequence") + ", " + std::to_string(finished) + " finished already";
    if (static_cast<std::size_t>(finished) < members.size())
      sentence += ", " + std::to_string(batch_.jobs) + " in parallel";
    if (!batch_.quiet) note(sentence);
  }

  /// Writes the summary of all results, and its page if Python can make it. Returns the worst exit code.
  int summarise(const std::vector<data::FoundSequence>& sequences, const Interruption& interruption) const {
    std::vector<std::string> names;
    for (const auto& sequence : sequences) names.push_back(sequence.name);
    auto summary = report::summarise(batch_.output, names, batch_.min_tracked);
    summary.command = command_line();
    summary.input = input_;
    summary.config = method_.config();
    remove_summary();
    data::write_atomically((output() / "summary.json").string(), report::summary_json(summary));
    // Page and tables are an extra: without Python, the message of make_page() is enough.
    const int page = make_page({batch_.output, "--output", (output() / "report.html").string(), "--markdown",
                                (output() / "summary.md").string(), "--quiet"},
                               interruption);
    print_summary(summary);
    const bool made = page == 0 || page == static_cast<int>(ExitCode::usage);
    return made ? summary.exit_code : report::worse_exit_code(summary.exit_code, page);
  }

  void print_summary(const report::BatchSummary& summary) const {
    const std::string tables = (output() / "summary.md").string();
    if (fs::is_regular_file(tables)) {
      std::printf("%s\n", data::read_bytes(tables).c_str());
    } else {
      const auto done = std::count_if(summary.rows.begin(), summary.rows.end(),
                                      [](const auto& row) { return row.status == report::MemberStatus::done; });
      std::printf("%d of %s done, %d of %s tracked\n", static_cast<int>(done),
                  data::counted(summary.rows.size(), "sequence").c_str(), summary.tracked,
                  data::counted(summary.frames, "frame").c_str());
    }
    std::printf("results in %s\n", batch_.output.c_str());
    std::fflush(stdout);  // before the complaints below
    for (const auto& row : summary.rows) {
      if (row.status == report::MemberStatus::done) continue;
      std::fprintf(stderr, "quadedge: %s (%s): %s\n", row.member.name.c_str(), to_string(row.status),
                   row.member.message.c_str());
    }
  }

  std::string input_, only_;
  BatchOptions batch_;
  bool list_ = false, gather_ = false;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_batch_command() { return std::make_unique<BatchCommand>(); }

}  // namespace quadedge::cli
