#include "report/frames_csv.hpp"

#include <cmath>
#include <cstdio>

#include "common/host_stages.hpp"
#include "common/numeric.hpp"
#include "data/text.hpp"
#include "report/run_record.hpp"

namespace quadedge::report {
namespace {

/// Empty for NaN.
std::string printed(const char* format, double value) {
  if (!std::isfinite(value)) return {};
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string milliseconds(double value) { return printed("%.3f", value); }
std::string four_digits(double value) { return printed("%.4g", value); }

/// Time that a frame spent in a stage [ms]; NaN where it did not reach it.
double stage_ms(const FrameResult& result, const std::string& stage) {
  double sum = kNan;
  for (const auto& part : result.timing.stages) {
    if (part.stage == stage) sum = (std::isnan(sum) ? 0 : sum) + part.ms;
  }
  return sum;
}

FrameColumns columns_of_frames() {
  FrameColumns columns;
  const auto add = [&](const std::string& name, std::function<std::string(const FrameResult&)> field) {
    columns.push_back({name, [field = std::move(field)](const NumberedFrame& frame) { return field(frame.result); }});
  };
  columns.push_back({"frame", [](const NumberedFrame& frame) { return std::to_string(frame.number); }});
  add("stamp_s", [](const FrameResult& result) { return data::format_seconds(result.stamp_ns); });
  add("status", [](const FrameResult& result) { return std::string(to_string(result.status)); });
  add("segment", [](const FrameResult& result) { return std::to_string(result.segment); });
  add("key_rig", [](const FrameResult& result) { return std::to_string(result.reference_frame); });
  add("new_key_rig", [](const FrameResult& result) { return std::string(result.new_key_rig ? "1" : "0"); });
  add("edge_threshold", [](const FrameResult& result) { return four_digits(result.diagnostics.edge_threshold); });
  add("disparity_range", [](const FrameResult& result) { return four_digits(result.diagnostics.disparity_range); });
  const auto counts = named_counts({});
  for (std::size_t i = 0; i < counts.size(); ++i) {
    add(counts[i].first,
        [i](const FrameResult& result) { return std::to_string(named_counts(result.counts)[i].second); });
  }
  add("matched_ratio",
      [](const FrameResult& result) { return four_digits(result.diagnostics.rig_evidence.matched_ratio); });
  add("epipolar_residual",
      [](const FrameResult& result) { return four_digits(result.diagnostics.rig_evidence.epipolar_residual); });
  add("moving_ratio", [](const FrameResult& result) { return four_digits(result.diagnostics.moving_ratio); });
  add("ambiguous_motion", [](const FrameResult& result) { return std::string(result.ambiguous_motion ? "1" : "0"); });
  add("latency_ms", [](const FrameResult& result) { return milliseconds(result.timing.latency_ms); });
  for (const char* stage : kHostStages) {
    add(std::string(stage) + "_ms",
        [stage](const FrameResult& result) { return milliseconds(stage_ms(result, stage)); });
  }
  add("warning", [](const FrameResult& result) { return joined(result.warnings); });
  add("message", [](const FrameResult& result) { return result.message; });
  return columns;
}

}  // namespace

const FrameColumns& frames_csv_columns() {
  static const FrameColumns all = columns_of_frames();
  return all;
}

CsvTable read_frames_csv(const std::string& file) { return {file, "a frames.csv of `quadedge run`"}; }

}  // namespace quadedge::report
