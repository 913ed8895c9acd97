#include "report/localisation_files.hpp"

#include <algorithm>
#include <map>

#include "data/text.hpp"
#include "report/json.hpp"
#include "report/json_values.hpp"
#include "report/poses_csv.hpp"
#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

using Column = CsvColumn<NumberedLocalisation>;

std::vector<Column> columns_of_locations() {
  std::vector<Column> columns;
  const auto add = [&](const std::string& name, std::function<std::string(const Localisation&)> field) {
    columns.push_back(
        {name, [field = std::move(field)](const NumberedLocalisation& frame) { return field(frame.result); }});
  };
  const auto add_located = [&](const std::string& name, std::function<std::string(const Localisation&)> field) {
    add(name, [field = std::move(field)](const Localisation& frame) {
      return frame.map_from_left ? field(frame) : std::string();
    });
  };
  columns.push_back({"frame", [](const NumberedLocalisation& frame) { return std::to_string(frame.number); }});
  add("stamp_s", [](const Localisation& frame) { return data::format_seconds(frame.stamp_ns); });
  add("status", [](const Localisation& frame) { return to_string(frame.status); });
  add_located("key_rig", [](const Localisation& frame) { return std::to_string(frame.key_rig); });
  add_located("followed", [](const Localisation& frame) { return std::to_string(frame.is_followed ? 1 : 0); });
  add_located("inliers", [](const Localisation& frame) { return std::to_string(frame.inliers); });
  add_located("support", [](const Localisation& frame) { return data::format_exact(frame.support); });
  for (std::size_t i = 0; i < kPoseColumns.size(); ++i)
    add_located(kPoseColumns[i],
                [i](const Localisation& frame) { return data::format_exact(pose_value(*frame.map_from_left, i)); });
  add("latency_ms", [](const Localisation& frame) { return data::format_exact(frame.latency_ms); });
  add("warning", [](const Localisation& frame) { return joined(frame.warnings); });
  add("message", [](const Localisation& frame) { return frame.message; });
  return columns;
}

std::map<LocalisationStatus, int> counts_of(const std::vector<Localisation>& frames) {
  std::map<LocalisationStatus, int> counts;
  for (const Localisation& frame : frames) ++counts[frame.status];
  return counts;
}

}  // namespace

const std::vector<Column>& locations_csv_columns() {
  static const std::vector<Column> all = columns_of_locations();
  return all;
}

std::string lost_reasons(const std::vector<Localisation>& frames) { return lost_reasons(counts_of(frames)); }

double median_latency_ms(const std::vector<Localisation>& frames) {
  std::vector<double> values;
  for (std::size_t i = frames.size() > 1 ? 1 : 0; i < frames.size(); ++i) values.push_back(frames[i].latency_ms);
  return median(values);
}

std::string localisation_json(const LocalisationRecord& record) {
  Json json;
  json["schema"] = kReportSchema;
  add_origin(json, record.command);
  json["device"] = to_json(record.device);
  json["map"] = {{"path", record.map_file}, {"key_rigs", record.key_rigs}};
  json["input"] = {{"path", record.input.path},
                   {"format", record.input.format},
                   {"name", record.input.name},
                   {"frames", record.frames.size()}};
  if (!record.ended_early.empty()) json["ended_early"] = record.ended_early;
  json["frames_located"] = record.located();
  json["frames"] = Json::object();
  for (const auto& [status, count] : counts_of(record.frames)) json["frames"][to_string(status)] = count;
  json["latency_ms"] = {{"median", to_json(median_latency_ms(record.frames))}};
  if (record.accuracy) {
    json["accuracy"] = {{"origin_aligned", to_json(record.accuracy->origin_aligned)},
                        {"se3_aligned", to_json(record.accuracy->se3_aligned)},
                        {"matched_poses", record.accuracy->matched},
                        {"truth_file", record.truth_file}};
  }
  add_configuration(json, record.config);
  return json_text(json);
}

}  // namespace quadedge::report
