/// \file summary_csv.cpp  summary.csv of a batch.
#include <cmath>

#include "data/text.hpp"
#include "report/batch_summary.hpp"
#include "report/csv_table.hpp"

namespace quadedge::report {
namespace {

std::string field(const std::string& text) { return csv_field(text); }
std::string field(double value) { return std::isfinite(value) ? data::format_exact(value) : std::string(); }

std::string names_of_errors() {
  std::string names;
  for (const char* alignment : {"origin_aligned", "se3_aligned"}) {
    for (const char* error : {"ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m"}) {
      for (const char* number : {"mean", "std", "rmse", "max"})
        names += std::string(",") + alignment + "_" + error + "_" + number;
    }
  }
  return names;
}

std::string error_columns(const PoseErrors& errors) {
  std::string fields;
  for (const auto* error :
       {&errors.ape_rotation_deg, &errors.ape_translation_m, &errors.rpe_rotation_deg, &errors.rpe_translation_m}) {
    for (const double value : {error->mean, error->std, error->rmse, error->max}) fields += "," + field(value);
  }
  return fields;
}

std::string accuracy(const std::optional<SummaryAccuracy>& accuracy) {
  constexpr int kColumns = 3 + 2 * 4 * 4;
  if (!accuracy) return std::string(kColumns, ',');
  return "," + std::to_string(accuracy->matched) + "," + field(accuracy->path_length_m) + "," +
         field(accuracy->end_drift_percent) + error_columns(accuracy->origin_aligned) +
         error_columns(accuracy->se3_aligned);
}

std::string latency(const LatencySummary& latency) {
  std::string fields;
  for (const double value : {latency.median, latency.p90, latency.p99, latency.max, latency.first})
    fields += "," + field(value);
  return fields;
}

std::string tracked(int tracked, int frames) {
  return std::to_string(frames) + "," + std::to_string(tracked) + "," +
         (frames > 0 ? field(static_cast<double>(tracked) / frames) : std::string());
}

}  // namespace

std::string summary_csv(const BatchSummary& summary) {
  std::string text =
      "kind,sequence,status,exit_code,path,format,frames,tracked,tracked_fraction,key_rigs,segments,matched_poses,"
      "path_length_m,end_drift_percent" +
      names_of_errors() +
      ",latency_ms_median,latency_ms_p90,latency_ms_p99,latency_ms_max,latency_ms_first,jobs,device,message\n";
  for (const auto& row : summary.rows) {
    const bool ran = row.status == MemberStatus::done || row.status == MemberStatus::too_few_tracked;
    text += "sequence," + field(row.member.name) + "," + to_string(row.status) + "," +
            std::to_string(row.member.exit_code) + "," + field(row.member.path) + "," + row.member.format + "," +
            (ran ? tracked(row.tracked, row.frames) : ",,") + "," +
            (ran ? std::to_string(row.key_rigs) + "," + std::to_string(row.segments) : ",") + accuracy(row.accuracy) +
            latency(row.latency) + "," + (row.status == MemberStatus::missing ? "" : std::to_string(row.member.jobs)) +
            "," + field(row.device) + "," + field(row.member.message) + "\n";
  }
  const std::string all = tracked(summary.tracked, summary.frames) + ",,";
  const std::string code = ",all,," + std::to_string(summary.exit_code) + ",,,",
                    end = latency(summary.latency) + ",,,\n";
  text += "pooled" + code + all + accuracy(summary.pooled) + end;
  text += "average" + code + all + accuracy(summary.average) + end;
  return text;
}

}  // namespace quadedge::report
