#include "report/batch_summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "common/numeric.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "quadedge/trajectory.hpp"
#include "report/json_values.hpp"
#include "report/rows.hpp"
#include "report/statistics.hpp"

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

namespace {

constexpr int kSummarySchema = 1;  // grows when a key changes its meaning

constexpr std::array<ErrorStatistics PoseErrors::*, 4> kErrors = {
    &PoseErrors::ape_rotation_deg, &PoseErrors::ape_translation_m, &PoseErrors::rpe_rotation_deg,
    &PoseErrors::rpe_translation_m};
constexpr std::array<PoseErrors TrajectoryEvaluation::*, 2> kAlignments = {&TrajectoryEvaluation::origin_aligned,
                                                                           &TrajectoryEvaluation::se3_aligned};

/// Statistics of the values behind several statistics, from their means and mean squares.
struct Pool {
  double count = 0, sum = 0, squares = 0, max = 0;
  void add(const ErrorStatistics& part, double values) {
    count += values;
    sum += values * part.mean;
    squares += values * part.rmse * part.rmse;
    max = std::max(max, part.max);
  }
  ErrorStatistics result() const {
    if (count == 0) return {kNan, kNan, kNan, kNan};
    const double mean = sum / count, mean_square = squares / count;
    return {mean, std::sqrt(std::max(0.0, mean_square - mean * mean)), std::sqrt(mean_square), max};
  }
};

std::vector<const TrajectoryEvaluation*> accuracies(const std::vector<SummaryRow>& rows) {
  std::vector<const TrajectoryEvaluation*> found;
  for (const auto& row : rows) {
    if (row.accuracy) found.push_back(&*row.accuracy);
  }
  return found;
}

/// Path and drift over all: the summed path, the drifts weighted with it.
void add_paths(TrajectoryEvaluation& total, const std::vector<const TrajectoryEvaluation*>& parts) {
  double drift = 0;
  for (const auto* part : parts) {
    total.matched += part->matched;
    total.rpe_steps += part->rpe_steps;
    total.path_length_m += part->path_length_m;
    drift += part->end_drift_percent * part->path_length_m;
  }
  total.end_drift_percent = total.path_length_m > 0 ? drift / total.path_length_m : 0;
}

TrajectoryEvaluation average(const std::vector<const TrajectoryEvaluation*>& parts) {
  TrajectoryEvaluation total;
  for (const auto alignment : kAlignments) {
    for (const auto error : kErrors) {
      ErrorStatistics mean;
      int count = 0;
      for (const auto* part : parts) {
        const ErrorStatistics& statistics = (part->*alignment).*error;
        if (!std::isfinite(statistics.mean)) continue;
        mean.mean += statistics.mean, mean.std += statistics.std, mean.rmse += statistics.rmse,
            mean.max += statistics.max;
        ++count;
      }
      const double scale = count > 0 ? 1.0 / count : kNan;
      (total.*alignment).*error = {mean.mean * scale, mean.std * scale, mean.rmse * scale, mean.max * scale};
    }
  }
  add_paths(total, parts);
  return total;
}

LatencySummary summary_of(const std::vector<double>& values, const std::vector<double>& firsts) {
  return {median(values), percentile(values, 0.9), percentile(values, 0.99), percentile(values, 1.0), median(firsts)};
}

}  // namespace

int worse_exit_code(int a, int b) {
  constexpr std::array<ExitCode, 6> kFromBadToWorse = {ExitCode::done, ExitCode::too_few_tracked, ExitCode::usage,
                                                       ExitCode::data, ExitCode::device,          ExitCode::internal};
  const auto rank = [&](int code) {
    return std::find(kFromBadToWorse.begin(), kFromBadToWorse.end(), static_cast<ExitCode>(code)) -
           kFromBadToWorse.begin();
  };
  return rank(a) >= rank(b) ? a : b;
}

std::optional<TrajectoryEvaluation> pooled_accuracy(const std::vector<const TrajectoryEvaluation*>& parts) {
  if (parts.empty()) return std::nullopt;
  TrajectoryEvaluation total;
  for (const auto alignment : kAlignments) {
    for (std::size_t error = 0; error < kErrors.size(); ++error) {
      Pool pool;
      for (const auto* part : parts) {
        const ErrorStatistics& statistics = (part->*alignment).*kErrors[error];
        if (std::isfinite(statistics.mean)) pool.add(statistics, error < 2 ? part->matched : part->rpe_steps);
      }
      (total.*alignment).*kErrors[error] = pool.result();
    }
  }
  add_paths(total, parts);
  return total;
}

BatchSummary summarise(const std::string& output, const std::vector<std::string>& names, double min_tracked) {
  BatchSummary summary;
  summary.min_tracked = min_tracked;
  std::vector<double> latencies, firsts;
  for (const auto& name : names) {
    const std::string folder = member_folder(output, name);
    SummaryRow& row = summary.rows.emplace_back(read_summary_row(folder, name, min_tracked));
    std::vector<double> frame_latencies;
    if (row.status == MemberStatus::done || row.status == MemberStatus::too_few_tracked) {
      try {
        frame_latencies = CsvTable(folder + "/frames.csv", "a frames.csv of `quadedge run`").numbers("latency_ms");
      } catch (const DataError& problem) {
        row = damaged(row, problem.what());
      }
    }
    if (row.status == MemberStatus::failed || row.status == MemberStatus::missing) {
      summary.exit_code = worse_exit_code(summary.exit_code, row.member.exit_code);
      continue;
    }
    if (row.status == MemberStatus::too_few_tracked) {
      summary.exit_code = worse_exit_code(summary.exit_code, static_cast<int>(ExitCode::too_few_tracked));
    }
    summary.frames += row.frames;
    summary.tracked += row.tracked;
    if (frame_latencies.empty()) continue;
    firsts.push_back(frame_latencies.front());
    latencies.insert(latencies.end(), frame_latencies.begin() + 1, frame_latencies.end());
  }
  summary.latency = summary_of(latencies, firsts);
  if (const auto parts = accuracies(summary.rows); !parts.empty()) {
    summary.pooled = pooled_accuracy(parts);
    summary.average = average(parts);
  }
  return summary;
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
  const std::string file = output + "/summary.json";
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
