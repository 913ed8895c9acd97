/// \file variant_comparison.cpp  Self-tests each variant, then times them in alternating order on one frame.
#include "benchmark/variant_comparison.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "benchmark/bench_record.hpp"
#include "benchmark/compare_frontends.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "device/variants.hpp"
#include "edges/prediction.hpp"
#include "output/json_values.hpp"
#include "output/statistics.hpp"
#include "quadedge/error.hpp"
#include "quadedge/self_test.hpp"
#include "rig/rectification_follower.hpp"

namespace quadedge::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kGuidedMatch = "temporal_match";  // one of its variants is a sequence of other stages
constexpr double kWorthChanging = 0.97;                 // of the default's time
constexpr double kHopeless = 2;                         // times the default's time, in each of so many measurements:
constexpr std::size_t kTrials = 3;

/// The names under which the pipeline profiles the kernels of a stage with variants.
std::vector<std::string> booked_as(const std::string& stage) {
  if (stage == kGuidedMatch) return {kGuidedMatch, "temporal_candidates", "candidate_filters", "temporal_quads"};
  return {stage};
}

/// One variant with its own pipeline.
struct Candidate {
  std::shared_ptr<Device> device;
  std::unique_ptr<rig::RectificationFollower> rows;
  std::unique_ptr<frontend::Frontend> frontend;
  frontend::FrontendOutput output;
  std::vector<double> times;
  bool is_paper = false;  ///< the front end is that of the paper's method
};

/// Whether further measurements of a variant would only confirm that it is slower.
bool is_hopeless(const std::vector<double>& times, const std::vector<double>& of_default) {
  const std::size_t both = std::min(times.size(), of_default.size());
  for (std::size_t i = 0; i < both; ++i)
    if (!(times[i] > kHopeless * of_default[i])) return false;
  return both >= kTrials;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

constexpr double kPaperSiftMax = 500;

/// The configuration with a variant, modified so that it runs the stage.
Config with_variant(Config config, const std::string& stage, const std::string& name) {
  if (stage == "grid_edges" || stage.rfind("paper_", 0) == 0) {
    auto variants = std::move(config.variants);
    config = read_preset("paper");
    config.variants = std::move(variants);
  }
  if (stage == "sift" && config.stereo.sift_max == 0) config.stereo.sift_max = kPaperSiftMax;
  if (stage == "coarse_disparity") config.stereo.coarse_ties = 0;
  if (stage == "temporal_candidates" || stage == "temporal_quads") config.variants[kGuidedMatch] = "lists";
  config.variants[stage] = name;
  return config;
}

/// Runs the second frame again. Returns the kernel time of the stage [ms], NaN if none ran.
double measure_once(const std::string& stage, const VariantInput& input, Candidate& candidate) {
  auto& context = *candidate.device->context();
  context.take_profile();
  candidate.frontend->process(input.second.view());
  const frontend::FrameEdges& first = *candidate.output.first;
  const auto match = [&](bool coarse) {
    candidate.frontend->match(first, frontend::search_without_motion(first.edges, input.config.temporal, coarse));
  };
  match(false);
  if (!candidate.is_paper) {
    if (stage != kGuidedMatch) match(true);
    frontend::as_global(*candidate.frontend).match_globally(first, input.config.temporal.global_edges);
  }
  const auto names = booked_as(stage);
  double sum = kNaN;
  for (const auto& row : context.take_profile()) {
    if (row.launches > 0 && std::find(names.begin(), names.end(), row.stage) != names.end())  // else only copies
      sum = std::isnan(sum) ? row.kernel_ms : sum + row.kernel_ms;
  }
  return sum;
}

using report::Json;

constexpr const char* kContent = "quadedge kernel variants";
constexpr int kSchema = 1;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw UsageError(path + ": " + why + "; remove the file, or replace it with `quadedge compare --save`");
}

}  // namespace

std::string StageResult::best() const {
  std::string best;
  double fastest = 1;
  for (const auto& variant : variants) {
    if (!variant.agrees || !std::isfinite(variant.median_ms)) continue;
    if (variant.is_default && best.empty()) best = variant.name;
    if (variant.ratio_p90 < 1 && variant.ratio_to_default < std::min(fastest, kWorthChanging)) {
      best = variant.name;
      fastest = variant.ratio_to_default;
    }
  }
  return best;
}

// LONG: four steps on one list of candidates: check, compare, measure, relate.
StageResult compare_variants(const std::string& stage, const VariantInput& input,
                             const std::function<void(const std::string&)>& progress) {
  StageResult result;
  result.stage = stage;
  std::vector<Candidate> candidates;
  std::size_t by_default = 0;
  for (const auto& variant : opencl::all_variants()) {
    if (variant.stage != stage) continue;
    progress("checking " + stage + " " + variant.name);
    VariantResult row;
    row.name = variant.name;
    row.median_ms = row.p10_ms = row.p90_ms = row.ratio_to_default = row.ratio_p90 = kNaN;
    Candidate candidate;
    candidate.device = input.device(false);
    row.is_default = opencl::choose_variant(stage, *candidate.device->context(), {}).name == variant.name;
    if (row.is_default) by_default = result.variants.size();
    try {
      const Config config = with_variant(input.config, stage, variant.name);
      const SelfTestResult test = self_test(*candidate.device, config);
      row.agrees = test.passed();
      if (!row.agrees) {
        row.why = "differs from the reference at " + test.stage + ": " + test.difference;
      } else {
        candidate.rows = std::make_unique<rig::RectificationFollower>(input.rig, config.stereo);
        candidate.frontend = frontend::make_frontend(input.rig, *candidate.device, config);
        candidate.frontend->correct_rows(candidate.rows.get());
        candidate.is_paper = config.is_paper();
        candidate.output = run_frontend(*candidate.frontend, input.first.view(), input.second.view(), config);
      }
    } catch (const DeviceError& error) {
      if (row.is_default) throw;
      row.runs = row.agrees = false;
      input.device(true);
      row.why = first_line(error.what());
    }
    result.variants.push_back(std::move(row));
    candidates.push_back(std::move(candidate));
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    auto& row = result.variants[i];
    if (!row.agrees || !result.variants[by_default].agrees) continue;
    // Without exact division variants may differ in the last bits; the comparison with the reference has decided.
    if (!candidates[i].device->info().single_precision.exact_divide_sqrt) continue;
    const std::string first = first_difference(candidates[i].output, candidates[by_default].output);
    if (first.empty()) continue;
    row.agrees = false;
    row.why = "differs from the default's bytes; first: " + first;
  }
  for (int repetition = 0; repetition < input.repetitions; ++repetition) {
    progress("measuring " + stage);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      // In alternating order, so that no variant always follows the same other one.
      const std::size_t i = repetition % 2 == 0 ? k : candidates.size() - 1 - k;
      if (result.variants[i].agrees && !is_hopeless(candidates[i].times, candidates[by_default].times))
        candidates[i].times.push_back(measure_once(stage, input, candidates[i]));
    }
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    auto& row = result.variants[i];
    const bool timed = !candidates[i].times.empty() && std::isfinite(candidates[i].times.front());
    if (row.agrees && !timed) row.why = "this input never runs the stage";
    if (!timed) continue;
    row.median_ms = report::median(candidates[i].times);
    row.p10_ms = report::percentile(candidates[i].times, 0.1);
    row.p90_ms = report::percentile(candidates[i].times, 0.9);
    std::vector<double> ratios;  // of consecutive measurements
    for (std::size_t k = 0; k < candidates[i].times.size(); ++k)
      ratios.push_back(candidates[i].times[k] / candidates[by_default].times[k]);
    row.ratio_to_default = report::median(ratios);
    row.ratio_p90 = report::percentile(ratios, 0.9);
  }
  return result;
}

std::vector<std::string> stages_with_variants() {
  std::vector<std::string> names;
  for (const auto& variant : opencl::all_variants()) {
    if (names.empty() || names.back() != variant.stage) names.push_back(variant.stage);
  }
  return names;
}

std::string comparison_json(const DeviceInfo& device, const std::vector<StageResult>& stages,
                            const std::string& command) {
  Json json;
  json["schema"] = kBenchSchema;
  report::add_origin(json, command);
  json["device"] = device;
  json["stages"] = Json::array();
  for (const auto& stage : stages) {
    Json rows = Json::array();
    for (const auto& variant : stage.variants) {
      rows.push_back({{"name", variant.name},
                      {"default", variant.is_default},
                      {"agrees", variant.agrees},
                      {"why", variant.why},
                      {"median_ms", variant.median_ms},
                      {"p10_ms", variant.p10_ms},
                      {"p90_ms", variant.p90_ms},
                      {"ratio_to_default", variant.ratio_to_default},
                      {"ratio_p90", variant.ratio_p90}});
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
  data::make_folder(std::filesystem::path(path).parent_path());
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
