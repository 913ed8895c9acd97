#include "cli/self_test_verdict.hpp"

#include <filesystem>
#include <fstream>

#include "data/atomic_file.hpp"
#include "data/content_hash.hpp"
#include "data/user_folder.hpp"
#include "opencl/kernel_sources.hpp"
#include "quadedge/error.hpp"
#include "report/json_values.hpp"
#include "report/source_commit.hpp"

namespace quadedge::cli {
namespace {

using report::Json;

constexpr const char* kContent = "quadedge self-test";

/// Stands for device, driver, kernels and program.
std::string fingerprint(const DeviceInfo& device, const std::map<std::string, std::string>& variants) {
  data::ContentHash hash;
  for (const auto& text : {device.platform, device.name, device.driver, device.opencl, std::string(QUADEDGE_VERSION),
                           std::string(report::source_commit())})
    hash.add(text);
  for (const auto& [file, text] : opencl::embedded_kernels()) hash.add(file + text);
  for (const auto& [stage, name] : variants) hash.add(stage + "=" + name);
  return hash.hex();
}

std::string verdict_path(const std::string& key) { return data::cache_folder() + "/self_tests/" + key + ".json"; }

}  // namespace

std::optional<SelfTestResult> kept_verdict(const DeviceInfo& device,
                                           const std::map<std::string, std::string>& variants) {
  if (data::cache_folder().empty()) return std::nullopt;
  const std::string key = fingerprint(device, variants);
  std::ifstream stream(verdict_path(key));
  if (!stream) return std::nullopt;
  const Json json = Json::parse(stream, nullptr, false);
  const auto text = [&](const char* name) { return json.value(name, std::string()); };
  if (!json.is_object() || text("content") != kContent || text("key") != key || !json.contains("stage"))
    return std::nullopt;
  return SelfTestResult{text("stage"), text("difference")};
}

void keep_verdict(const DeviceInfo& device, const std::map<std::string, std::string>& variants,
                  const SelfTestResult& result) {
  if (data::cache_folder().empty()) return;
  const std::string key = fingerprint(device, variants);
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

}  // namespace quadedge::cli
