/// \file command_batch.cpp  quadedge batch: says what is to be run and starts Snakemake (python/quadedge/batch), which
/// runs it.
#include <cstdio>
#include <dlfcn.h>
#include <filesystem>
#include <link.h>
#include <thread>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/method_options.hpp"
#include "cli/processes.hpp"
#include "data/atomic_file.hpp"
#include "data/content_hash.hpp"
#include "data/find_sequences.hpp"
#include "output/config_toml.hpp"
#include "output/json_values.hpp"
#include "output/output_folder.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace fs = std::filesystem;
using report::Json;
namespace {

constexpr int kPlanSchema = 1;  // grows when a key changes its meaning
constexpr int kThumbnails = 4;  // of every sequence; the page shows them

/// The file that holds the program's code: a library where the Python package runs it, else the program itself.
std::string code_file() {
  Dl_info about{};
  link_map* file = nullptr;
  const bool found =
      dladdr1(reinterpret_cast<void*>(&code_file), &about, reinterpret_cast<void**>(&file), RTLD_DL_LINKMAP) != 0;
  return found && *file->l_name != '\0' ? file->l_name : kProgramFile;
}

/// The file with the ground truth of a recording; empty if it has none or cannot be opened, which its run reports.
std::string truth_file(const data::FoundSequence& sequence) {
  if (sequence.source) return {};
  try {
    return open_dataset(sequence.path).truth_file;
  } catch (const Error&) {
    return {};
  }
}

class BatchCommand : public Command {
 public:
  BatchCommand()
      : Command("batch", "track many sequences with Snakemake, each in its own process, and summarise the results",
                "  quadedge batch eth3d/training -o results\n"
                "  quadedge batch sequences.txt -o results --device gpu -- --executor slurm --jobs 20") {}
  void declare(Options& options) override {
    options.positional("ROOT|LIST", input_,
                       "folder with sequences at any depth, or a file with one folder, or one camera source, per line");
    options.positionals("SNAKEMAKE", snakemake_, "after --: options of Snakemake, such as --executor slurm", false);
    options.text("-o,--output", output_, "output folder; default: quadedge_batch in the current folder", "OUT");
    options.number("--jobs", jobs_,
                   "number of sequences tracked in parallel; 0: one, or one per core with --device reference");
    options.flag("--loops", loops_, "recognise places and close loops in every sequence");
    options.number("--draw", draw_every_, "draw the edges and quads of every N-th frame");
    options.number("--min-tracked", min_tracked_,
                   "exit with code 5 if fewer frames of a sequence are tracked [percent]");
    options.flag("--list", list_, "print name and folder of every sequence; track none");
    options.flag("--dry-run", dry_run_, "print which sequences would be tracked; track none");
    options.flag("--force", force_, "repeat finished sequences");
    options.flag("--quiet", quiet_, "hide progress; warnings and the summary remain");
    method_.declare(options);
  }

  int run() override {
    check_options();
    const auto sequences = data::find_sequences(input_);
    if (list_) {
      for (const auto& sequence : sequences) std::printf("%s\t%s\n", sequence.name.c_str(), sequence.path.c_str());
      return 0;
    }
    const auto python = find_python("quadedge.batch");
    if (python.found.empty()) {
      print_error(
          "batch needs Snakemake 9, and " + python.tried +
          " has no module quadedge.batch with it; scripts/run.sh in a clone of QuadEdge installs both beside its "
          "program; elsewhere `pip install 'snakemake>=9'` beside the Python package, and set QUADEDGE_PYTHON "
          "to that Python");
      return static_cast<int>(ExitCode::usage);
    }
    if (snakemake_.empty()) method_.open_device();  // a missing device ends the batch here, not in every run
    output_ = fs::absolute(output_).string();
    data::make_folder(fs::path(output_) / "sequences");
    const report::FolderLock lock((fs::path(output_) / ".lock").string(), output_);
    const std::string config = report::config_toml(method_.config(), method_.device_choice());
    data::write_atomically(output_ + "/config.toml", config);
    data::write_atomically(output_ + "/batch.json", report::json_text(plan(sequences, config)));
    std::vector<std::string> words = {"-m", "quadedge.batch", output_};
    if (dry_run_) words.emplace_back("--dry-run");
    if (force_) words.emplace_back("--force");
    if (quiet_) words.emplace_back("--quiet");
    words.emplace_back("--");
    words.insert(words.end(), snakemake_.begin(), snakemake_.end());
    lock.keep_in_next_program();
    become(python.found, words);
  }

 private:
  void check_options() const {
    if (jobs_ < 0) throw UsageError("--jobs " + std::to_string(jobs_) + ": expected 0 (chosen by device) or more");
    if (draw_every_ < 0) throw UsageError("--draw " + std::to_string(draw_every_) + ": expected 0 (none) or more");
    if (!(min_tracked_ >= 0 && min_tracked_ <= 100)) throw UsageError("--min-tracked: expected 0 to 100 percent");
    if (!snakemake_.empty() && snakemake_.front()[0] != '-')
      throw UsageError("'" + snakemake_.front() + "': expected one folder or list, then -- and options of Snakemake");
    method_.config();  // reports wrong options before data is read
  }

  /// Sequences at the same time: as many as do not disturb one another. An OpenCL device carries one (a CPU gives it
  /// all cores, and on a GPU the kernels of others delay it), the plain C++ reference one per core.
  int jobs() const {
    if (jobs_ > 0) return jobs_;
    if (method_.device_choice() != "reference") return 1;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }

  /// What every `quadedge run` of the batch is given beside its sequence.
  std::vector<std::string> run_options() const {
    std::vector<std::string> words = {"--config",      output_ + "/config.toml",
                                      "--device",      method_.device_choice(),
                                      "--thumbnails",  std::to_string(kThumbnails),
                                      "--draw",        std::to_string(draw_every_),
                                      "--min-tracked", "0"};
    if (!method_.kernel_folder().empty())
      words.insert(words.end(), {"--kernels", fs::absolute(method_.kernel_folder()).string()});
    if (method_.trusts()) words.emplace_back("--trust");
    if (loops_) words.emplace_back("--loops");
    return words;
  }

  /// batch.json, which python/quadedge/batch reads. `key` stands for program, options and configuration: a sequence
  /// that was run with another one is run again.
  Json plan(const std::vector<data::FoundSequence>& sequences, const std::string& config) const {
    data::ContentHash key;
    for (const auto& text : {std::string(QUADEDGE_VERSION), data::file_hash(code_file()), config}) key.add(text);
    const auto options = run_options();
    for (const auto& word : options) key.add(word);
    Json json;
    json["schema"] = kPlanSchema;
    report::add_origin(json, command_line());
    json["input"] = input_;
    report::add_configuration(json, method_.config());
    json["min_tracked_percent"] = min_tracked_;
    json["program"] = fs::read_symlink(kProgramFile).string();
    json["directory"] = fs::current_path().string();
    json["options"] = options;
    if (method_.threads() != 0) {  // which changes times alone
      json["options"].push_back("--threads");
      json["options"].push_back(std::to_string(method_.threads()));
    }
    json["kernels"] = method_.kernel_folder();
    json["key"] = key.hex();
    json["jobs"] = jobs();
    json["sequences"] = Json::array();
    for (const auto& sequence : sequences) {
      const auto& source = sequence.source;
      json["sequences"].push_back(
          {{"name", sequence.name},
           {"path", sequence.path},
           {"format", sequence.format},
           {"words", source ? data::source_words(*source) : std::vector<std::string>{sequence.path}},
           {"truth", truth_file(sequence)}});
    }
    return json;
  }

  std::string input_, output_ = "quadedge_batch";
  std::vector<std::string> snakemake_;
  int jobs_ = 0, draw_every_ = 0;
  double min_tracked_ = 50;
  bool list_ = false, dry_run_ = false, force_ = false, quiet_ = false, loops_ = false;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_batch_command() { return std::make_unique<BatchCommand>(); }

}  // namespace quadedge::cli
