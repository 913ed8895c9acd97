#include "report/frames_csv.hpp"

#include <algorithm>
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

std::string grey_levels(double value) {
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

}  // namespace

FramesCsv::FramesCsv(const std::string& path) : file_(path) { file_.append(header()); }

void FramesCsv::add(const FrameResult& result) {
  bool new_stage = false;
  for (const auto& stage : result.stages) {
    if (std::find(stages_.begin(), stages_.end(), stage.stage) != stages_.end()) continue;
    stages_.push_back(stage.stage);
    new_stage = true;
  }
  frames_.push_back(result);
  if (!new_stage) {
    file_.append(row(frames_.size() - 1));
    return;
  }
  std::string text = header();
  for (std::size_t i = 0; i < frames_.size(); ++i) text += row(i);
  file_.clear();
  file_.append(text);
}

std::string FramesCsv::header() const {
  std::string text = "frame,stamp_s,status,key_rig,new_key_rig,edge_threshold";
  for (const auto& [name, unused] : named_counts({})) {
    (void)unused;
    text += "," + name;
  }
  text += ",latency_ms";
  for (const auto& stage : stages_) text += "," + stage + "_ms";
  return text + ",message\n";
}

std::string FramesCsv::row(std::size_t frame) const {
  const FrameResult& result = frames_[frame];
  std::string text = std::to_string(frame) + "," + data::format_seconds(result.stamp_ns) + "," +
                     to_string(result.status) + "," + std::to_string(result.reference_frame) + "," +
                     (result.new_key_rig ? "1" : "0") + "," + grey_levels(result.edge_threshold);
  for (const auto& [name, count] : named_counts(result.counts)) text += "," + std::to_string(count);
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
  return text + "," + (result.message.empty() ? "" : quoted_field(result.message)) + "\n";
}

}  // namespace quadedge::report
