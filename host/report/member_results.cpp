#include "report/member_results.hpp"

#include <filesystem>

#include "common/numeric.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "quadedge/trajectory.hpp"
#include "report/json_values.hpp"
#include "report/rows.hpp"

namespace quadedge::report {
namespace {

constexpr int kMemberSchema = 1;  // grows when a key changes its meaning

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

/// A text that was cut ends within a line, or has fewer of them.
void check_end(const std::string& file) {
  const std::string text = data::read_bytes(file);
  if (text.empty() || text.back() != '\n') data::fail(file, "an end within a line", "a whole file");
}

void check_count(const std::string& file, std::size_t found, int expected) {
  if (found == static_cast<std::size_t>(expected)) return;
  data::fail(file, data::counted(found, "row"), std::to_string(expected) + " as in report.json");
}

}  // namespace

const char* to_string(MemberStatus status) {
  switch (status) {
    case MemberStatus::done: return "done";
    case MemberStatus::too_few_tracked: return "too few tracked";
    case MemberStatus::failed: return "failed";
    case MemberStatus::missing: return "not run";
  }
  return "";
}

std::string member_folder(const std::string& output, const std::string& name) {
  return (std::filesystem::path(output) / "sequences" / name).string();
}

std::string member_json(const MemberRecord& record) {
  Json json;
  json["schema"] = kMemberSchema;
  json["name"] = record.name;
  json["path"] = record.path;
  json["format"] = record.format;
  json["key"] = record.key;
  json["exit_code"] = record.exit_code;
  json["message"] = record.message;
  json["jobs"] = record.jobs;
  return json_text(json);
}

std::optional<MemberRecord> read_member(const std::string& folder) {
  const std::string file = folder + "/member.json";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  try {
    const auto json = Json::parse(data::read_bytes(file));
    if (json.at("schema") != kMemberSchema) return std::nullopt;
    MemberRecord record;
    record.name = json.at("name");
    record.path = json.at("path");
    record.format = json.at("format");
    record.key = json.at("key");
    record.exit_code = json.at("exit_code");
    record.message = json.at("message");
    record.jobs = json.at("jobs");
    return record;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

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

void check_whole(const std::string& folder) {
  const SummaryRow row = read_summary_row(folder, "", 0);
  if (row.status != MemberStatus::done) throw DataError(row.member.message);
  const std::string tum = folder + "/trajectory.txt", kitti = folder + "/trajectory_kitti.txt",
                    frames = folder + "/frames.csv", poses = folder + "/poses.csv", config = folder + "/config.toml",
                    truth = folder + "/groundtruth.txt", errors = folder + "/errors.csv";
  for (const auto* file : {&tum, &kitti, &frames, &poses, &config}) check_end(*file);
  check_count(tum, read_tum(tum).size(), row.tracked);
  check_count(kitti, read_kitti(kitti).size(), row.frames);
  check_count(frames, CsvTable(frames, "a frames.csv of `quadedge run`").rows(), row.frames);
  check_count(poses, CsvTable(poses, "a poses.csv of `quadedge run`").rows(), row.frames);
  if (!row.accuracy) return;
  check_end(truth);
  read_tum(truth);
  check_end(errors);
  check_count(errors, CsvTable(errors, "an errors.csv of `quadedge run`").rows(), row.accuracy->matched);
}

}  // namespace quadedge::report
