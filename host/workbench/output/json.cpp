/// \file json.cpp  Assembles the documents key by key.
#include "output/json.hpp"

#include <map>

#include "output/json_values.hpp"
#include "output/statistics.hpp"

namespace quadedge::report {
namespace {

Json accuracy(const TrajectoryEvaluation& evaluation) {
  Json json = evaluation;
  json["estimate_poses"] = evaluation.estimate_poses;
  json["truth_poses"] = evaluation.truth_poses;
  for (const auto& segment : evaluation.segments) {
    json["segments"].push_back(segment);
    json["segments"].back()["segment"] = segment.segment;
  }
  return json;
}

Json normalised(const evaluation::Consistency& consistency) {
  return {{"pose", consistency.pose}, {"rotation", consistency.rotation}, {"translation", consistency.translation}};
}

Json consistency(const evaluation::StepConsistency& step) {
  return {{"frames", step.frames},
          {"motions", step.edges.poses},
          {"error_m", step.error_m},
          {"promised_m", step.promised_m},
          {"error_deg", step.error_deg},
          {"promised_deg", step.promised_deg},
          {"normalised_error_squared_by_edges", normalised(step.edges)},
          {"normalised_error_squared", normalised(step.with_rig)}};
}

Json stages(const std::vector<std::vector<StageTime>>& frames) {
  Json object = Json::object();
  for (const auto& row : stage_summary(frames)) object[row.stage] = {{"median", row.median}, {"p90", row.p90}};
  return object;
}

Json loops_json(const LoopFacts& loops) {
  return {{"compared", loops.compared}, {"kept", loops.kept},         {"segments", loops.segments},
          {"frames", loops.frames},     {"key_rigs", loops.key_rigs}, {"megabytes", loops.megabytes},
          {"total_ms", loops.total_ms}, {"latency_ms", loops.latency}};
}

std::map<LocalisationStatus, int> counts_of(const std::vector<Localisation>& frames) {
  std::map<LocalisationStatus, int> counts;
  for (const Localisation& frame : frames) ++counts[frame.status];
  return counts;
}

}  // namespace

std::string report_json(const RunRecord& run) {
  int key_rigs = 0, overflows = 0, ambiguous = 0;
  for (const auto& frame : run.frames) {
    key_rigs += frame.new_key_rig ? 1 : 0;
    overflows += frame.diagnostics.overflow ? 1 : 0;
    ambiguous += frame.ambiguous_motion ? 1 : 0;
  }
  Json report;
  report["schema"] = kReportSchema;
  add_origin(report, run.command);
  report["device"] = run.device;
  report["self_test"] = {{"verdict", run.self_test.verdict},
                         {"stage", run.self_test.test.stage},
                         {"difference", run.self_test.test.difference}};
  report["variants"] = Json(run.variants);
  report["input"] = {{"path", run.input.path},      {"format", run.input.format}, {"name", run.input.name},
                     {"frames", run.input.frames},  {"width", run.input.width},   {"height", run.input.height},
                     {"dropped", run.input.dropped}};
  for (std::size_t i = 0; i + 1 < run.input.options.size(); i += 2)
    report["input"]["options"][run.input.options[i].substr(2)] = run.input.options[i + 1];
  if (!run.ended_early.empty()) report["ended_early"] = run.ended_early;
  report["frames_tracked"] = run.tracked();
  report["frames_lost"] = static_cast<int>(run.frames.size()) - run.tracked();
  report["frames_overflowed"] = overflows;
  report["key_rigs"] = key_rigs;
  report["frames_ambiguous"] = ambiguous;
  report["segments"] = run.frames.empty() ? 0 : run.frames.back().segment + 1;
  if (const std::string text = segments_text(run.frames); !text.empty()) report["segments_text"] = text;
  report["path_length_m"] = path_length_m(run.frames);
  if (!run.frames.empty()) report["disparity_error_px"] = run.frames.back().rig.disparity_error;
  report["warnings"] = Json::array();
  for (const auto& warning : run.input.warnings) report["warnings"].push_back({{"frame", nullptr}, {"text", warning}});
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    for (const Warning& warning : run.frames[i].warnings)
      report["warnings"].push_back({{"frame", i}, {"kind", to_string(warning.kind)}, {"text", warning.text}});
  }
  report["latency_ms"] = latency_summary(run.frames);
  report["stages_ms"] = stages(stage_times(run.frames));
  if (!run.kernel_times.empty()) report["kernels_ms"] = stages(run.kernel_times);
  report["start_ms"] = {{"total", run.start_ms}, {"kernel_build", run.kernel_build_ms}};
  report["memory_mb"] = {{"host_peak", run.host_peak_mb}, {"device_peak", run.device_peak_mb}};
  report["counts"] = Json::object();
  for (const auto& [name, value] : count_medians(run.frames)) report["counts"][name] = value;
  if (run.points) {
    report["points"] = {
        {"count", run.points->points}, {"key_rigs", run.points->views}, {"dropped", run.points->dropped}};
  }
  if (run.loops) report["loops"] = loops_json(*run.loops);
  if (run.accuracy) {
    report["accuracy"] = accuracy(*run.accuracy);
    report["accuracy"]["truth_file"] = run.truth_file;
    for (const auto& step : run.step_consistency) report["accuracy"]["consistency"].push_back(consistency(step));
  }
  add_configuration(report, run.config);
  return json_text(report);
}

std::string evaluation_json(const TrajectoryEvaluation& evaluation, const std::string& estimate,
                            const std::string& truth, const std::string& command,
                            const std::optional<evaluation::StepJudgement>& steps) {
  Json json;
  json["schema"] = kReportSchema;
  add_origin(json, command);
  json["estimate"] = estimate;
  json["truth"] = truth;
  json["accuracy"] = accuracy(evaluation);
  if (steps) {
    json["steps"] = {{"right", steps->right},
                     {"wrong", steps->wrong},
                     {"lost", steps->lost},
                     {"wrong_stamps_ns", steps->wrong_stamps_ns}};
  }
  json["per_pose"] = Json::array();
  for (const auto& pose : evaluation.per_pose) {
    json["per_pose"].push_back({{"stamp_ns", pose.stamp_ns},
                                {"ape_rotation_deg", pose.ape_rotation_deg},
                                {"ape_translation_m", pose.ape_translation_m},
                                {"rpe_rotation_deg", pose.rpe_rotation_deg},
                                {"rpe_translation_m", pose.rpe_translation_m}});
  }
  return json_text(json);
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
  json["device"] = record.device;
  json["map"] = {{"path", record.map_file}, {"key_rigs", record.key_rigs}};
  json["input"] = {{"path", record.input.path},
                   {"format", record.input.format},
                   {"name", record.input.name},
                   {"frames", record.frames.size()}};
  if (!record.ended_early.empty()) json["ended_early"] = record.ended_early;
  json["frames_located"] = record.located();
  json["frames"] = Json::object();
  for (const auto& [status, count] : counts_of(record.frames)) json["frames"][to_string(status)] = count;
  json["latency_ms"] = {{"median", median_latency_ms(record.frames)}};
  if (record.accuracy) {
    json["accuracy"] = {{"origin_aligned", record.accuracy->origin_aligned},
                        {"se3_aligned", record.accuracy->se3_aligned},
                        {"matched_poses", record.accuracy->matched},
                        {"truth_file", record.truth_file}};
  }
  add_configuration(json, record.config);
  return json_text(json);
}

}  // namespace quadedge::report
