#include "report/frames_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "data/text.hpp"
#include "report/run_record.hpp"

namespace quadedge::report {
namespace {

std::string milliseconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

/// Empty where there is none.
std::string four_digits(double value) {
  if (!std::isfinite(value)) return {};
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// A field in quotes, as RFC 4180 wants it for free text.
std::string quoted_field(const std::string& text) {
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c == '\n' ? ' ' : c;
  }
  return field + "\"";
}

/// Where a row's last field, the message, begins: behind the last comma that stands in no quotes.
std::size_t message_begin(const std::string& row) {
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] == '"') quoted = !quoted;
    if (row[i] == ',' && !quoted) begin = i + 1;
  }
  return begin;
}

}  // namespace

FramesCsv::FramesCsv(const std::string& path) : path_(path), file_(path) { file_.append(header()); }

void FramesCsv::add(const FrameResult& result) {
  const std::size_t before = stages_.size();
  for (const auto& stage : result.stages) {
    if (std::find(stages_.begin(), stages_.end(), stage.stage) == stages_.end()) stages_.push_back(stage.stage);
  }
  if (stages_.size() > before) add_empty_columns(stages_.size() - before);
  file_.append(row(result));
  ++frames_;
}

/// Writes the file anew with columns for stages that the frames in it did not have.
void FramesCsv::add_empty_columns(std::size_t count) {
  std::string text = header();
  for (const auto& line : data::data_lines(path_)) {
    if (line.number == 1) continue;
    const std::size_t message = message_begin(line.text);
    text += line.text.substr(0, message) + std::string(count, ',') + line.text.substr(message) + "\n";
  }
  file_.clear();
  file_.append(text);
}

std::string FramesCsv::header() const {
  std::string text = "frame,stamp_s,status,key_rig,new_key_rig,edge_threshold";
  for (const auto& [name, unused] : named_counts({})) {
    (void)unused;
    text += "," + name;
  }
  text += ",matched_ratio,epipolar_residual,moving_ratio,ambiguous_motion,latency_ms";
  for (const auto& stage : stages_) text += "," + stage + "_ms";
  return text + ",warning,message\n";
}

std::string FramesCsv::row(const FrameResult& result) const {
  std::string text = std::to_string(frames_) + "," + data::format_seconds(result.stamp_ns) + "," +
                     to_string(result.status) + "," + std::to_string(result.reference_frame) + "," +
                     (result.new_key_rig ? "1" : "0") + "," + four_digits(result.edge_threshold);
  for (const auto& [name, count] : named_counts(result.counts)) text += "," + std::to_string(count);
  text += "," + four_digits(result.rig.matched_ratio) + "," + four_digits(result.rig.epipolar_residual) + "," +
          four_digits(result.moving_ratio) + "," + (result.ambiguous_motion ? "1" : "0");
  text += "," + milliseconds(result.latency_ms);
  for (const auto& name : stages_) {
    double sum = 0;
    bool seen = false;
    for (const auto& stage : result.stages) {
      if (stage.stage != name) continue;
      sum += stage.ms;
      seen = true;
    }
    text += "," + (seen ? milliseconds(sum) : std::string());
  }
  for (const std::string* words : {&result.warning, &result.message})
    text += "," + (words->empty() ? std::string() : quoted_field(*words));
  return text + "\n";
}

}  // namespace quadedge::report
