#include "benchmark/variants_file.hpp"

#include <cctype>
#include <filesystem>

#include "benchmark/bench_record.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "data/user_folder.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"
#include "report/json_values.hpp"

namespace quadedge::bench {
namespace {

using report::Json;
using report::to_json;

constexpr const char* kContent = "quadedge kernel variants";
constexpr int kSchema = 1;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw UsageError(path + ": " + why + "; remove the file, or replace it with `quadedge compare --save`");
}

}  // namespace

std::string comparison_json(const DeviceInfo& device, const std::vector<StageResult>& stages,
                            const std::string& command) {
  Json json;
  json["schema"] = kBenchSchema;
  report::add_origin(json, command);
  json["device"] = report::to_json(device);
  json["stages"] = Json::array();
  for (const auto& stage : stages) {
    Json rows = Json::array();
    for (const auto& variant : stage.variants) {
      rows.push_back({{"name", variant.name},
                      {"default", variant.is_default},
                      {"agrees", variant.agrees},
                      {"why", variant.why},
                      {"median_ms", to_json(variant.median_ms)},
                      {"p10_ms", to_json(variant.p10_ms)},
                      {"p90_ms", to_json(variant.p90_ms)},
                      {"ratio_to_default", to_json(variant.ratio_to_default)},
                      {"ratio_p90", to_json(variant.ratio_p90)}});
    }
    json["stages"].push_back({{"stage", stage.stage}, {"best", stage.best()}, {"variants", rows}});
  }
  return report::json_text(json);
}

std::string variants_file_name(const DeviceInfo& device) {
  std::string name;
  for (const unsigned char c : device.name) {
    if (std::isalnum(c)) {
      name += static_cast<char>(c);
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  return "variants-" + name + ".json";
}

void write_variants_file(const std::string& path, const DeviceInfo& device,
                         const std::map<std::string, std::string>& variants) {
  Json json;
  json["content"] = kContent;
  json["schema"] = kSchema;
  json["version"] = QUADEDGE_VERSION;
  json["device"] = {{"name", device.name}, {"platform", device.platform}, {"driver", device.driver}};
  json["variants"] = variants;
  std::error_code failed;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), failed);
  if (failed) throw DataError(path + ": its folder cannot be created: " + failed.message());
  data::write_atomically(path, report::json_text(json));
}

std::map<std::string, std::string> read_variants_file(const std::string& path, const DeviceInfo& device) {
  if (!std::filesystem::exists(path)) return {};
  const std::string text = data::read_bytes(path);
  std::map<std::string, std::string> variants;
  try {
    const Json json = Json::parse(text);
    if (json.at("content") != kContent) refuse(path, "does not contain kernel variants");
    if (json.at("schema") != kSchema) {
      refuse(path, "has schema " + json.at("schema").dump() + ", this program reads " + std::to_string(kSchema));
    }
    const auto name = json.at("device").at("name").get<std::string>(),
               platform = json.at("device").at("platform").get<std::string>();
    if (name != device.name || platform != device.platform) {
      refuse(path, "belongs to " + name + " (" + platform + "), this is " + device.name + " (" + device.platform + ")");
    }
    variants = json.at("variants").get<std::map<std::string, std::string>>();
  } catch (const Json::exception& error) {
    refuse(path, std::string("is not a file of kernel variants (") + error.what() + ")");
  }
  try {
    opencl::check_variants(variants);
  } catch (const UsageError& error) {
    refuse(path, error.what());
  }
  return variants;
}

std::string saved_variants_path(const DeviceInfo& device) {
  const std::string folder = data::configuration_folder();
  return folder.empty() ? folder : folder + "/" + variants_file_name(device);
}

void add_saved_variants(const Device& device, Config& config) {
  if (device.is_reference()) return;
  const std::string path = saved_variants_path(device.info());
  if (path.empty()) return;
  const auto saved = read_variants_file(path, device.info());
  config.variants.insert(saved.begin(), saved.end());  // what is there already stays
}

}  // namespace quadedge::bench
