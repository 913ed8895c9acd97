/// \file json.cpp  Results of runs and trajectories; with matching_json.cpp the only file that includes nlohmann-json.
#include "report/json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace quadedge::report {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: a value that does not exist is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json statistics(const ErrorStatistics& error) {
  return {{"mean", number(error.mean)}, {"std", number(error.std)}, {"rmse", number(error.rmse)}, {"max", number(error.max)}};
}

Json pose_errors(const PoseErrors& errors) {
  return {{"ape_rotation_deg", statistics(errors.ape_rotation_deg)},
          {"ape_translation_m", statistics(errors.ape_translation_m)},
          {"rpe_rotation_deg", statistics(errors.rpe_rotation_deg)},
          {"rpe_translation_m", statistics(errors.rpe_translation_m)}};
}

Json accuracy(const TrajectoryEvaluation& evaluation) {
  return {{"origin_aligned", pose_errors(evaluation.origin_aligned)},
          {"se3_aligned", pose_errors(evaluation.se3_aligned)},
          {"matched_poses", evaluation.matched},
          {"estimate_poses", evaluation.estimate_poses},
          {"truth_poses", evaluation.truth_poses},
          {"path_length_m", number(evaluation.path_length_m)},
          {"end_drift_percent", number(evaluation.end_drift_percent)}};
}

Json stages(const std::vector<std::vector<StageTime>>& frames) {
  Json object = Json::object();
  for (const auto& row : stage_summary(frames)) object[row.stage] = {{"median", number(row.median)}, {"p90", number(row.p90)}};
  return object;
}

Json configuration(Config config) {
  Json object = Json::object();
  visit_config(config, [&](const std::string& name, ConfigField field, const std::string&, double, double) {
    const auto dot = name.find('.');
    Json& target = dot == std::string::npos ? object[name] : object[name.substr(0, dot)][name.substr(dot + 1)];
    std::visit([&](const auto* value) { target = *value; }, field);
  });
  return object;
}

std::string text(const Json& json) {
  // Names of files may hold bytes that are no UTF-8; they are replaced instead of failing.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string report_json(const RunRecord& run) {
  const LatencySummary latency = latency_summary(run.frames);
  int key_rigs = 0, overflows = 0;
  for (const auto& frame : run.frames) {
    key_rigs += frame.result.new_key_rig ? 1 : 0;
    overflows += frame.result.overflow ? 1 : 0;
  }
  Json report;
  report["schema"] = kReportSchema;
  report["version"] = QUADEDGE_VERSION;
  report["device"] = {{"name", run.device.name}, {"platform", run.device.platform}, {"driver", run.device.driver},
                      {"opencl", run.device.opencl}, {"type", run.device.type}};
  report["variants"] = Json(run.variants);
  report["input"] = {{"path", run.input.path}, {"format", run.input.format}, {"name", run.input.name},
                     {"frames", run.input.frames}, {"width", run.input.width}, {"height", run.input.height}};
  report["frames_tracked"] = run.tracked();
  report["frames_lost"] = static_cast<int>(run.frames.size()) - run.tracked();
  report["frames_overflowed"] = overflows;
  report["key_rigs"] = key_rigs;
  report["latency_ms"] = {{"median", number(latency.median)}, {"p90", number(latency.p90)}, {"p99", number(latency.p99)},
                          {"max", number(latency.max)}, {"first", number(latency.first)}};
  report["stages_ms"] = stages(stage_times(run.frames));
  if (!run.kernel_times.empty()) report["kernels_ms"] = stages(run.kernel_times);
  report["start_ms"] = {{"total", run.start_ms}, {"kernel_build", run.kernel_build_ms}};
  report["memory_mb"] = {{"host_peak", run.host_peak_mb}, {"device_peak", run.device_peak_mb}};
  report["counts"] = Json::object();
  for (const auto& [name, value] : count_medians(run.frames)) report["counts"][name] = number(value);
  if (run.accuracy) {
    report["accuracy"] = accuracy(*run.accuracy);
    report["accuracy"]["truth_file"] = run.truth_file;
  }
  report["config"] = configuration(run.config);
  return text(report);
}

std::string evaluation_json(const TrajectoryEvaluation& evaluation, const std::string& estimate, const std::string& truth) {
  Json json;
  json["schema"] = kReportSchema;
  json["version"] = QUADEDGE_VERSION;
  json["estimate"] = estimate;
  json["truth"] = truth;
  json["accuracy"] = accuracy(evaluation);
  json["per_pose"] = Json::array();
  for (const auto& pose : evaluation.per_pose) {
    json["per_pose"].push_back({{"stamp_ns", pose.stamp_ns},
                                {"ape_rotation_deg", number(pose.ape_rotation_deg)},
                                {"ape_translation_m", number(pose.ape_translation_m)},
                                {"rpe_rotation_deg", number(pose.rpe_rotation_deg)},
                                {"rpe_translation_m", number(pose.rpe_translation_m)}});
  }
  return text(json);
}

std::string trace_json(const RunRecord& run) {
  constexpr double kMicroseconds = 1000;  // per millisecond
  Json events = Json::array();
  const auto add = [&](const std::string& name, const char* category, double start_ms, double duration_ms, int thread) -> Json& {
    events.push_back({{"name", name}, {"cat", category}, {"ph", "X"}, {"pid", 1}, {"tid", thread},
                      {"ts", start_ms * kMicroseconds}, {"dur", duration_ms * kMicroseconds}});
    return events.back();
  };
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const auto& frame = run.frames[i];
    add("frame " + std::to_string(i), "frame", frame.start_ms, frame.result.latency_ms, 1)["args"] = {
        {"status", to_string(frame.result.status)}, {"inliers", frame.result.counts.inliers}};
    double start = frame.start_ms;
    for (const auto& stage : frame.result.stages) {
      add(stage.stage, "stage", start, stage.ms, 1);
      start += stage.ms;
    }
    if (i >= run.kernel_times.size()) continue;
    start = frame.start_ms;
    for (const auto& kernel : run.kernel_times[i]) {
      add(kernel.stage, "kernel time of the profiling pass", start, kernel.ms, 2);
      start += kernel.ms;
    }
  }
  Json trace;
  trace["displayTimeUnit"] = "ms";
  trace["otherData"] = {{"version", QUADEDGE_VERSION}, {"device", run.device.name}, {"input", run.input.path}};
  trace["traceEvents"] = std::move(events);
  return text(trace);
}

}  // namespace quadedge::report
