#include "cli/batch_plan.hpp"

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>
#include <link.h>
#include <thread>

#include "cli/child_process.hpp"
#include "cli/console.hpp"
#include "data/content_hash.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "quadedge/stereo_source.hpp"
#include "report/config_toml.hpp"
#include "report/member_results.hpp"

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

}  // namespace quadedge::cli
