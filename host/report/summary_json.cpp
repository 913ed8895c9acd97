/// \file summary_json.cpp  Results of a batch as JSON, and read from the report.json of its sequences.
#include <filesystem>

#include "common/numeric.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "report/batch_summary.hpp"
#include "report/json_values.hpp"

namespace quadedge::report {
namespace {

constexpr int kSummarySchema = 1;  // grows when a key changes its meaning

Json read_json(const std::string& file, const char* expected) {
  try {
    return Json::parse(data::read_bytes(file));
  } catch (const Json::exception& problem) {
    data::fail(file, std::string("no JSON (") + problem.what() + ")", expected);
  }
}

/// Takes over what a run reported. \throws nlohmann::json::exception.
void take_report(SummaryRow& row, const Json& report) {
  row.frames = report.at("input").at("frames");
  row.tracked = report.at("frames_tracked");
  row.key_rigs = report.at("key_rigs");
  row.segments = report.value("segments", 1);
  row.device = report.at("device").at("name");
  row.latency = to_latency(report.at("latency_ms"));
  if (!report.contains("accuracy")) return;
  const Json& accuracy = report.at("accuracy");
  TrajectoryEvaluation& found = row.accuracy.emplace();
  found.origin_aligned = to_pose_errors(accuracy.at("origin_aligned"));
  found.se3_aligned = to_pose_errors(accuracy.at("se3_aligned"));
  found.se3_open_rotation = accuracy.value("se3_open_rotation", std::string());
  found.matched = accuracy.at("matched_poses");
  found.rpe_steps = accuracy.value("rpe_steps", found.matched - 1);
  found.path_length_m = to_number(accuracy.at("path_length_m"));
  found.end_drift_percent = to_number(accuracy.at("end_drift_percent"));
}

}  // namespace

SummaryRow read_summary_row(const std::string& folder, const std::string& name, double min_tracked) {
  SummaryRow row;
  row.latency = {kNan, kNan, kNan, kNan, kNan};
  const auto member = read_member(folder);
  if (!member) {
    row.member.name = name;
    row.member.exit_code = static_cast<int>(ExitCode::data);
    row.member.message = "not run";
    return row;
  }
  row.member = *member;
  row.status = MemberStatus::failed;
  if (member->exit_code != 0) return row;
  try {
    const std::string file = folder + "/report.json";
    const Json report = read_json(file, "the report of a run");
    try {
      take_report(row, report);
    } catch (const Json::exception& problem) {
      data::fail(file, problem.what(), "the report of a run");
    }
  } catch (const DataError& problem) {
    return damaged(row, problem.what());
  }
  const bool enough = 100.0 * row.tracked >= min_tracked * row.frames;
  row.status = enough ? MemberStatus::done : MemberStatus::too_few_tracked;
  if (!enough) {
    row.member.exit_code = static_cast<int>(ExitCode::too_few_tracked);
    row.member.message = "tracked " + std::to_string(row.tracked) + " of " + data::counted(row.frames, "frame");
  }
  return row;
}

SummaryRow damaged(SummaryRow row, const std::string& complaint) {
  SummaryRow failed;
  failed.member = std::move(row.member);
  failed.member.exit_code = static_cast<int>(ExitCode::data);
  failed.member.message = "its results are damaged: " + complaint;
  failed.status = MemberStatus::failed;
  failed.latency = {kNan, kNan, kNan, kNan, kNan};
  return failed;
}

std::string summary_json(const BatchSummary& summary) {
  Json json;
  json["schema"] = kSummarySchema;
  add_origin(json, summary.command);
  json["input"] = summary.input;
  if (summary.config) add_configuration(json, *summary.config);
  json["exit_code"] = summary.exit_code;
  json["min_tracked_percent"] = summary.min_tracked;
  json["sequences"] = Json::array();
  for (const auto& row : summary.rows) {
    Json entry = {
        {"name", row.member.name},       {"status", to_string(row.status)}, {"exit_code", row.member.exit_code},
        {"message", row.member.message}, {"path", row.member.path},         {"format", row.member.format},
        {"jobs", row.member.jobs}};
    if (row.status == MemberStatus::done || row.status == MemberStatus::too_few_tracked) {
      entry["device"] = row.device;
      entry["frames"] = row.frames;
      entry["frames_tracked"] = row.tracked;
      entry["tracked_fraction"] = row.frames > 0 ? Json(static_cast<double>(row.tracked) / row.frames) : Json(nullptr);
      entry["key_rigs"] = row.key_rigs;
      entry["segments"] = row.segments;
      if (row.accuracy) entry["accuracy"] = to_json(*row.accuracy);
      entry["latency_ms"] = to_json(row.latency);
    }
    json["sequences"].push_back(std::move(entry));
  }
  Json& all = json["all"];
  all["frames"] = summary.frames;
  all["frames_tracked"] = summary.tracked;
  all["tracked_fraction"] =
      summary.frames > 0 ? Json(static_cast<double>(summary.tracked) / summary.frames) : Json(nullptr);
  if (summary.pooled) all["pooled"] = to_json(*summary.pooled);
  if (summary.average) all["average"] = to_json(*summary.average);
  all["latency_ms"] = to_json(summary.latency);
  return json_text(json);
}

SummarisedBatch summarised_batch(const std::string& output) {
  const std::string file = (std::filesystem::path(output) / "summary.json").string();
  const Json json = read_json(file, "the summary of a batch");
  SummarisedBatch batch;
  try {
    for (const auto& entry : json.at("sequences")) batch.names.push_back(entry.at("name"));
    batch.min_tracked = json.at("min_tracked_percent");
  } catch (const Json::exception& problem) {
    data::fail(file, problem.what(), "the summary of a batch");
  }
  return batch;
}

}  // namespace quadedge::report
