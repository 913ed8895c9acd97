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

/// t_rel and r_rel over sub-paths of one length, or of all.
static Json to_json(const SubPathErrors& errors) {
  return {{"sub_paths", errors.count},
          {"t_rel_percent", to_json(errors.translation_percent)},
          {"t_rel_sd_percent", to_json(errors.translation_sd_percent)},
          {"r_rel_deg_per_m", to_json(errors.rotation_deg_per_m)},
          {"r_rel_sd_deg_per_m", to_json(errors.rotation_sd_deg_per_m)}};
}

Json to_json(const TrajectoryEvaluation& evaluation) {
  Json json = {{"origin_aligned", to_json(evaluation.origin_aligned)},
               {"se3_aligned", to_json(evaluation.se3_aligned)},
               {"matched_poses", evaluation.matched},
               {"ate_rmse_m", to_json(evaluation.se3_aligned.ape_translation_m.rmse)},
               {"rpe_steps", evaluation.rpe_steps},
               {"rpe_interval", {{"frames", 1}, {"seconds", to_json(evaluation.rpe_interval_s)}}},
               {"path_length_m", to_json(evaluation.path_length_m)},
               {"end_drift_percent", to_json(evaluation.end_drift_percent)}};
  json["sub_paths"] = {{"all", to_json(evaluation.sub_path_mean)}, {"by_length", Json::array()}};
  for (const SubPathErrors& errors : evaluation.sub_paths) {
    if (errors.count == 0) continue;
    Json entry = {{"length_m", errors.length_m}};
    entry.update(to_json(errors));
    json["sub_paths"]["by_length"].push_back(entry);
  }
  if (!evaluation.se3_open_rotation.empty()) json["se3_open_rotation"] = evaluation.se3_open_rotation;
  return json;
}

}  // namespace quadedge::report
