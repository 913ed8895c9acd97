#include "report/errors_csv.hpp"

#include <cmath>

#include "data/text.hpp"

namespace quadedge::report {
namespace {

using PerPose = TrajectoryEvaluation::PerPose;

std::vector<CsvColumn<PerPose>> columns_of_errors() {
  std::vector<CsvColumn<PerPose>> columns = {
      {"stamp_s", [](const PerPose& pose) { return data::format_seconds(pose.stamp_ns); }}};
  const auto add = [&](const char* name, double PerPose::*error) {
    columns.push_back({name, [error](const PerPose& pose) {
                         return std::isfinite(pose.*error) ? data::format_exact(pose.*error) : std::string();
                       }});
  };
  add("ape_rotation_deg", &PerPose::ape_rotation_deg);
  add("ape_translation_m", &PerPose::ape_translation_m);
  add("rpe_rotation_deg", &PerPose::rpe_rotation_deg);
  add("rpe_translation_m", &PerPose::rpe_translation_m);
  return columns;
}

}  // namespace

std::string errors_csv(const TrajectoryEvaluation& evaluation) {
  const auto columns = columns_of_errors();
  std::string text = csv_heading(columns);
  for (const auto& pose : evaluation.per_pose) text += csv_row(columns, pose);
  return text;
}

CsvTable read_errors_csv(const std::string& file) { return {file, "an errors.csv of `quadedge run`"}; }

}  // namespace quadedge::report
