/// \file method_options.cpp  Tries devices by preference until one passes the self-test; caches verdicts by a hash.
#include "cli/method_options.hpp"

#include <filesystem>
#include <fstream>

#include "cli/console.hpp"
#include "data/atomic_file.hpp"
#include "data/content_hash.hpp"
#include "device/kernel_sources.hpp"
#include "device/variants.hpp"
#include "output/config_toml.hpp"
#include "output/json_values.hpp"
#include "quadedge/error.hpp"
#include "quadedge/threads.hpp"

namespace quadedge::cli {
namespace {

using report::Json;

constexpr const char* kContent = "quadedge self-test";

/// Stands for device, driver, kernels and program.
std::string fingerprint(const DeviceInfo& device, const std::map<std::string, std::string>& variants,
                        const std::string& method) {
  data::ContentHash hash;
  for (const auto& text : {device.platform, device.name, device.driver, device.opencl, std::string(QUADEDGE_VERSION),
                           std::string(report::source_commit())})
    hash.add(text);
  for (const auto& [file, text] : opencl::embedded_kernels()) hash.add(file + text);
  for (const auto& [stage, name] : variants) hash.add(stage + "=" + name);
  hash.add(method);
  return hash.hex();
}

std::string verdict_path(const std::string& key) { return data::cache_folder() + "/self_tests/" + key + ".json"; }

constexpr const char* kShared = "Method and device";

/// Heading of a section's constants in the help.
std::string heading(const std::string& section) {
  for (const auto& known : constant_sections()) {
    if (known.name == section)
      return known.title + " (doc/method.md section " + std::to_string(known.method_section) + ")";
  }
  return kShared;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Keeps a verdict in $XDG_CACHE_HOME/quadedge/self_tests (~/.cache without it). Where that cannot be written, the next
/// start tests again.
void keep_verdict(const DeviceInfo& device, const std::map<std::string, std::string>& variants,
                  const std::string& method, const SelfTestResult& result) {
  if (data::cache_folder().empty()) return;
  const std::string key = fingerprint(device, variants, method);
  const Json json = {{"content", kContent},   {"key", key},
                     {"device", device.name}, {"driver", device.driver},
                     {"stage", result.stage}, {"difference", result.difference},
                     {"variants", variants}};
  std::error_code failed;
  std::filesystem::create_directories(data::cache_folder() + "/self_tests", failed);
  try {
    data::write_atomically(verdict_path(key), report::json_text(json));
  } catch (const DataError&) {
    std::filesystem::remove(verdict_path(key), failed);  // tested again the next time
  }
}

/// The verdict on a device; not cached for kernels from a folder, which are being worked on.
SelfTestResult verdict(Device& device, const Config& config, bool own_kernels) {
  if (device.is_reference()) return {};
  const auto kept = own_kernels ? kept_verdict(device.info(), config.variants, config.method) : std::nullopt;
  if (kept) return *kept;
  const SelfTestResult result = self_test(device, config);
  if (own_kernels) keep_verdict(device.info(), config.variants, config.method, result);
  return result;
}

}  // namespace

std::optional<SelfTestResult> kept_verdict(const DeviceInfo& device, const std::map<std::string, std::string>& variants,
                                           const std::string& method) {
  if (data::cache_folder().empty()) return std::nullopt;
  const std::string key = fingerprint(device, variants, method);
  std::ifstream stream(verdict_path(key));
  if (!stream) return std::nullopt;
  const Json json = Json::parse(stream, nullptr, false);
  const auto text = [&](const char* name) { return json.value(name, std::string()); };
  if (!json.is_object() || text("content") != kContent || text("key") != key || !json.contains("stage"))
    return std::nullopt;
  return SelfTestResult{text("stage"), text("difference")};
}

void MethodOptions::declare(Options& options) {
  options.group(kShared);
  options.text("--device", device_, "auto, cpu, gpu, reference, a number from `quadedge devices`, or part of a name",
               "DEVICE");
  options.environment("QUADEDGE_DEVICE");
  options.number("--threads", threads_, "threads to compute with at most, here and in OpenCL on CPUs; 0: all");
  options.flag("--trust", trusts_, "use a device even if it fails the self-test");
  options.config_file();
  options.repeated("--variant", variants_, "kernel variant of a stage (`quadedge variants` lists them); repeatable",
                   "STAGE=NAME");
  options.text("--kernels", kernels_, "read the kernels from this folder instead of the program", "DIR");
  for (const Constant& constant : constants()) {
    options.group(heading(constant.section), !constant.basic);
    options.constant(constant, config_);
  }
}

void MethodOptions::assume_exact_rig() {
  PoseConfig& pose = config_.pose;
  pose.rig_sigma_length = pose.rig_sigma_axis = pose.rig_sigma_lens = 0;
}

Config MethodOptions::config() const {
  Config config = config_;
  for (const auto& choice : variants_) report::add_variant(choice, config);
  opencl::check_variants(config.variants);
  check_config(config);
  return config;
}

std::vector<std::string> MethodOptions::choices() const {
  if (device_ != "auto") return {device_};
  std::vector<std::string> numbers;
  for (const auto& device : by_preference(list_devices())) numbers.push_back(std::to_string(device.index));
  if (numbers.empty()) numbers.push_back(device_);  // fails, and says what to install
  return numbers;
}

Device MethodOptions::open_device(const std::string& choice, const DeviceOptions& options, SelfTestResult* test) const {
  Device device(choice, options);
  const SelfTestResult result = verdict(device, config(), kernels_.empty());
  if (test != nullptr) *test = result;
  if (!result.passed() && !trusts_) {
    throw DeviceError(device.info().name + " (" + device.info().platform + ", " + device.info().driver +
                      ") fails the self-test at stage " + result.stage + ": " + result.difference +
                      ". Choose another device or driver (`quadedge devices`), or use this one with --trust");
  }
  return device;
}

Device MethodOptions::open_device(bool profiling, SelfTestResult* test) const {
  limit_threads(threads_);
  DeviceOptions options;
  options.kernel_folder = kernels_;
  options.profiling = profiling;
  if (!data::cache_folder().empty()) options.program_folder = data::cache_folder() + "/programs";
  const std::vector<std::string> all = choices();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    try {
      return open_device(all[i], options, test);
    } catch (const DeviceError& error) {
      note("warning: device " + all[i] + " is skipped: " + first_line(error.what()) + "; trying device " + all[i + 1] +
           " (--device " + all[i] + " would end here)");
    }
  }
  return open_device(all.back(), options, test);
}

}  // namespace quadedge::cli
