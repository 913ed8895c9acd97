#include "cli/batch.hpp"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <link.h>
#include <list>
#include <thread>

#include "cli/console.hpp"
#include "cli/processes.hpp"
#include "common/printed.hpp"
#include "common/timing.hpp"
#include "data/atomic_file.hpp"
#include "data/content_hash.hpp"
#include "data/find_sequences.hpp"
#include "data/text.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "quadedge/stereo_source.hpp"
#include "report/batch_summary.hpp"
#include "report/config_toml.hpp"
#include "report/output_folder.hpp"

namespace quadedge::cli {
namespace fs = std::filesystem;
namespace {

/// The file that holds the program's code: a library where the Python package runs it, else the program itself.
std::string code_file() {
  Dl_info about{};
  link_map* file = nullptr;
  const bool found =
      dladdr1(reinterpret_cast<void*>(&code_file), &about, reinterpret_cast<void**>(&file), RTLD_DL_LINKMAP) != 0;
  return found && *file->l_name != '\0' ? file->l_name : kProgramFile;
}

/// Fingerprint of what all sequences of a batch share: program (version and file), configuration, kernels, device, and
/// which pictures and measurements are made.
std::string common_key(const MethodOptions& method, const DeviceInfo& device, const BatchOptions& options) {
  data::ContentHash hash;
  hash.add(std::string_view(QUADEDGE_VERSION));
  hash.add(data::file_hash(code_file()));
  hash.add(report::config_toml(method.config(), ""));
  for (const auto& text : {device.platform, device.name, device.driver, device.opencl}) hash.add(text);
  if (!method.kernel_folder().empty()) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(method.kernel_folder(), error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().extension() == ".cl") files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
      hash.add(file.filename().string());
      hash.add(data::file_hash(file.string()));
    }
  }
  hash.add({static_cast<double>(options.draw_every), static_cast<double>(options.thumbnails),
            options.profile ? 1.0 : 0.0, options.loops ? 1.0 : 0.0});
  return hash.hex();
}

/// Does the folder hold the whole result of a run with this key?
bool is_finished(const std::string& folder, const std::string& key, bool timing) {
  const auto member = report::read_member(folder);
  if (!member || member->exit_code != 0 || member->key != key || key.empty()) return false;
  if (timing && member->jobs > 1) return false;
  try {
    report::check_whole(folder);
  } catch (const DataError&) {
    return false;
  }
  return true;
}

}  // namespace

std::vector<BatchMember> plan_batch(const std::vector<data::FoundSequence>& sequences, const MethodOptions& method,
                                    const DeviceInfo& device, const BatchOptions& options) {
  const std::string common = common_key(method, device, options);
  std::vector<BatchMember> plan;
  StatusLine status(options.quiet);
  for (const auto& sequence : sequences) {
    if (status.due()) {
      status.show("looking at " + sequence.name + "  " + std::to_string(plan.size()) + "/" +
                  std::to_string(sequences.size()));
    }
    BatchMember& member = plan.emplace_back();
    member.sequence = sequence;
    try {
      const Dataset dataset = sequence.source ? open_stereo_source(*sequence.source) : open_dataset(sequence.path);
      member.frames = static_cast<int>(dataset.frames.size());
      member.pixels = static_cast<double>(member.frames) * dataset.rig.left.width * dataset.rig.left.height;
      data::ContentHash hash;
      hash.add(common);
      hash.add(data::dataset_hash(dataset));
      member.key = hash.hex();
    } catch (const Error&) {
      continue;  // its run will say what is wrong, and that is what the batch records
    }
    member.finished =
        !options.force && is_finished(report::member_folder(options.output, sequence.name), member.key, options.timing);
  }
  return plan;
}

int default_jobs(const DeviceInfo& device, const BatchOptions& options) {
  if (device.type != "reference" || options.timing || options.profile) return 1;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

constexpr const char* kError = "/error.txt";  // of a member at work
constexpr std::chrono::milliseconds kPoll{30};
constexpr std::chrono::seconds kGrace{5};  // for a child to end after it was asked to

/// A member at work.
struct RunningMember {
  const BatchMember& member;
  std::string folder;  ///< unfinished
  report::FolderLock lock;
  ChildProcess child;
};

/// Finished frames of a running sequence, whose trajectory_kitti.txt gets a row per frame.
int finished_frames(const std::string& folder) {
  std::ifstream file(folder + "/trajectory_kitti.txt", std::ios::binary);
  return static_cast<int>(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
}

/// Why a child failed, from its end and the file with its error. (What follows the first line names the folder of that
/// time.)
std::string failure(const ChildEnd& end, const std::string& error) {
  if (end.signal != 0) {
    std::string text = "ended by signal " + std::to_string(end.signal) + " (" + strsignal(end.signal) + ")";
    if (end.signal == SIGKILL) text += "; perhaps the memory ran out";
    return text;
  }
  std::string text;
  std::ifstream file(error);
  if (std::getline(file, text) && !text.empty()) return text;
  return "ended with exit code " + std::to_string(end.exit_code) + " and no message";
}

class BatchRunner {
 public:
  /// `to_run`, `pixels`: of all that has to be run now; `already`: sequences that were finished before.
  BatchRunner(const MethodOptions& method, const BatchOptions& options, int jobs, int to_run, int already,
              double pixels)
      : method_(method),
        options_(options),
        jobs_(jobs),
        status_(options.quiet),
        sequences_(already + to_run),
        over_(already),
        pixels_(pixels) {}

  void start(const BatchMember& member) {
    const std::string& name = member.sequence.name;
    const fs::path unfinished = fs::path(options_.output) / "unfinished";
    const std::string folder = (unfinished / name).string();
    data::make_folder(unfinished);
    report::FolderLock lock((unfinished / (name + ".lock")).string(), false, folder);
    data::remove_all(folder);
    data::make_folder(folder);
    running_.push_back({member, folder, std::move(lock),
                        ChildProcess(arguments(member, folder), folder + "/log.txt", folder + kError)});
  }

  /// Takes in the members that are over.
  void reap() {
    for (auto running = running_.begin(); running != running_.end();) {
      const auto end = running->child.ended();
      if (end) {
        finish(*running, *end);
        running = running_.erase(running);
      } else {
        ++running;
      }
    }
  }

  void show_progress() {
    if (!status_.due()) return;
    const double seconds = milliseconds_since(start_) / 1000;
    std::string text = numbers();
    int frames = frames_;
    double pixels = pixels_over_;
    const char* separator = " ";
    for (const auto& running : running_) {
      const int done = finished_frames(running.folder), all = running.member.frames;
      text += separator + running.member.sequence.name;
      if (all > 0) text += " frame " + std::to_string(done) + "/" + std::to_string(all);
      if (all > 0) pixels += running.member.pixels * done / all;
      frames += done;
      separator = ", ";
    }
    if (frames > 0) text += printed("  %.1f frames/s", frames / seconds);
    // Pixels tell more about the time that is left than frames: sequences differ in their size.
    if (pixels > 0) text += ", " + duration_text(seconds * std::max(0.0, pixels_ - pixels) / pixels) + " left";
    status_.show(text);
  }

  /// Ends all children and removes what they have begun.
  void abandon() {
    for (const auto& running : running_) running.child.terminate();
    const auto deadline = std::chrono::steady_clock::now() + kGrace;
    for (auto& running : running_) {
      while (!running.child.ended() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(kPoll);
    }
    std::vector<std::string> folders;
    for (const auto& running : running_) folders.push_back(running.folder);
    running_.clear();  // kills the ones that are left
    for (const auto& folder : folders) data::remove_all(folder);
  }

  std::size_t running() const { return running_.size(); }

 private:
  std::string numbers() const { return "[" + std::to_string(over_) + "/" + std::to_string(sequences_) + "]"; }

  std::vector<std::string> arguments(const BatchMember& member, const std::string& folder) const {
    std::vector<std::string> arguments = {"run",
                                          "--output",
                                          folder,
                                          "--min-tracked",
                                          "0",
                                          "--config",
                                          (fs::path(options_.output) / "config.toml").string(),
                                          "--device",
                                          method_.device_choice(),
                                          "--thumbnails",
                                          std::to_string(options_.thumbnails),
                                          "--draw",
                                          std::to_string(options_.draw_every)};
    const auto& source = member.sequence.source;
    for (const auto& word : source ? data::source_words(*source) : std::vector<std::string>{member.sequence.path})
      arguments.push_back(word);
    if (!method_.kernel_folder().empty()) arguments.insert(arguments.end(), {"--kernels", method_.kernel_folder()});
    if (method_.trusts()) arguments.push_back("--trust");
    if (method_.threads() != 0)
      arguments.insert(arguments.end(), {"--threads", std::to_string(method_.threads())});
    if (options_.profile) arguments.push_back("--profile");
    if (options_.loops) arguments.push_back("--loops");
    return arguments;
  }

  void finish(RunningMember& running, const ChildEnd& end) {
    const BatchMember& member = running.member;
    report::MemberRecord record;
    record.name = member.sequence.name;
    record.path = member.sequence.path;
    record.format = member.sequence.format;
    record.key = member.key;
    const bool known = end.exit_code <= static_cast<int>(ExitCode::too_few_tracked);
    record.exit_code = known ? end.exit_code : static_cast<int>(ExitCode::internal);
    record.jobs = jobs_;
    if (record.exit_code != 0) record.message = failure(end, running.folder + kError);
    std::error_code error;
    fs::remove(running.folder + kError, error);
    data::write_atomically(running.folder + "/member.json", report::member_json(record));
    const std::string folder = report::member_folder(options_.output, member.sequence.name);
    data::remove_all(folder);
    fs::rename(running.folder, folder, error);
    if (error) throw DataError(folder + ": the finished folder cannot be put here: " + error.message());
    ++over_;
    frames_ += member.frames;
    pixels_over_ += member.pixels;
    status_.say(numbers() + " " + member.sequence.name + ": " + outcome(folder, record));
  }

  std::string outcome(const std::string& folder, const report::MemberRecord& record) const {
    if (record.exit_code != 0) return "failed: " + record.message;
    const auto row = report::read_summary_row(folder, record.name, options_.min_tracked);
    std::string text = std::to_string(row.tracked) + " of " + data::counted(row.frames, "frame") + " tracked";
    if (row.accuracy) {
      text += printed(", APE %.3f deg, %.4f m", row.accuracy->origin_aligned.ape_rotation_deg.mean,
                      row.accuracy->origin_aligned.ape_translation_m.mean);
    }
    return text;
  }

  const MethodOptions& method_;
  const BatchOptions& options_;
  int jobs_;
  StatusLine status_;
  Clock::time_point start_ = Clock::now();
  int sequences_, over_, frames_ = 0;  ///< of the batch, of these finished; frames finished now
  double pixels_, pixels_over_ = 0;    ///< to run, and finished
  std::list<RunningMember> running_;
};

}  // namespace

int run_batch(const std::vector<BatchMember>& plan, const MethodOptions& method, const BatchOptions& options,
              const Interruption& interruption) {
  std::vector<const BatchMember*> waiting;
  double pixels = 0;
  for (const auto& member : plan) {
    if (member.finished) continue;
    waiting.push_back(&member);
    pixels += member.pixels;
  }
  const int to_run = static_cast<int>(waiting.size());
  // As many as the whole batch has, not what is left of it: a batch that was interrupted ends with the same records.
  const int jobs = std::min(options.jobs, static_cast<int>(plan.size()));
  BatchRunner runner(method, options, jobs, to_run, static_cast<int>(plan.size()) - to_run, pixels);
  std::size_t next = 0;
  while (next < waiting.size() || runner.running() > 0) {
    if (interruption.signal() != 0) {
      const auto begun = static_cast<int>(runner.running());
      runner.abandon();
      return static_cast<int>(next) - begun;
    }
    while (next < waiting.size() && runner.running() < static_cast<std::size_t>(jobs)) runner.start(*waiting[next++]);
    std::this_thread::sleep_for(kPoll);
    if (interruption.signal() != 0) continue;  // Ctrl-C also ends the children, which is not a result
    runner.reap();
    runner.show_progress();
  }
  return to_run;
}

}  // namespace quadedge::cli
