/// \file json_values.cpp  The origin, all constants and those that are changed, and the figures of an evaluation.
#include "output/json_values.hpp"

#include <ctime>

#include "data/text.hpp"

namespace quadedge::report {

Json read_json(const std::string& file, const char* expected) {
  try {
    return Json::parse(data::read_bytes(file));
  } catch (const Json::exception& problem) {
    data::fail(file, std::string("no JSON (") + problem.what() + ")", expected);
  }
}

void add_origin(Json& json, const std::string& command) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
  json["version"] = QUADEDGE_VERSION;
  json["commit"] = *source_commit() == '\0' ? Json(nullptr) : Json(source_commit());
  json["date"] = date;
  json["command"] = command;
}

void add_configuration(Json& json, const Config& config) {
  const Config defaults;
  Config copy = config;  // a constant's field can be written, too
  json["config"] = Json::object();
  json["config_changed"] = Json::object();
  for (const Constant& constant : constants()) {
    Json& section = constant.section.empty() ? json["config"] : json["config"][constant.section];
    std::visit([&](const auto* value) { section[constant.name] = *value; }, constant.field(copy));
    const std::string text = constant.text(config);
    if (text != constant.text(defaults)) json["config_changed"][constant.key()] = text;
  }
}

}  // namespace quadedge::report

namespace quadedge {

/// t_rel and r_rel over sub-paths of one length, or of all.
static void to_json(report::Json& json, const SubPathErrors& errors) {
  json = {{"sub_paths", errors.count},
          {"t_rel_percent", errors.translation_percent},
          {"t_rel_sd_percent", errors.translation_sd_percent},
          {"r_rel_deg_per_m", errors.rotation_deg_per_m},
          {"r_rel_sd_deg_per_m", errors.rotation_sd_deg_per_m}};
}

void to_json(report::Json& json, const TrajectoryEvaluation& evaluation) {
  json = {{"origin_aligned", evaluation.origin_aligned},
          {"se3_aligned", evaluation.se3_aligned},
          {"matched_poses", evaluation.matched},
          {"ate_rmse_m", evaluation.se3_aligned.ape_translation_m.rmse},
          {"rpe_steps", evaluation.rpe_steps},
          {"rpe_interval", {{"frames", 1}, {"seconds", evaluation.rpe_interval_s}}},
          {"path_length_m", evaluation.path_length_m},
          {"end_drift_percent", evaluation.end_drift_percent}};
  json["sub_paths"] = {{"all", evaluation.sub_path_mean}, {"by_length", report::Json::array()}};
  for (const SubPathErrors& errors : evaluation.sub_paths) {
    if (errors.count == 0) continue;
    report::Json entry = {{"length_m", errors.length_m}};
    entry.update(errors);
    json["sub_paths"]["by_length"].push_back(entry);
  }
  if (!evaluation.se3_open_rotation.empty()) json["se3_open_rotation"] = evaluation.se3_open_rotation;
}

void to_json(report::Json& json, const DeviceInfo& device) {
  const FloatSupport& support = device.single_precision;
  json = {{"name", device.name},
          {"platform", device.platform},
          {"driver", device.driver},
          {"opencl", device.opencl},
          {"type", device.type},
          {"single_precision",
           {{"fma", support.fma},
            {"denormals", support.denormals},
            {"rounding", report::Json::array()},
            {"correctly_rounded_divide_sqrt", support.exact_divide_sqrt}}}};
  report::Json& rounding = json["single_precision"]["rounding"];
  if (support.rounds_to_nearest) rounding.push_back("nearest");
  if (support.rounds_to_zero) rounding.push_back("zero");
  if (support.rounds_to_infinity) rounding.push_back("infinity");
}

}  // namespace quadedge
