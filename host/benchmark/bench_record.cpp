#include "benchmark/bench_record.hpp"

#include "report/json.hpp"
#include "report/json_values.hpp"
#include "report/statistics.hpp"

namespace quadedge::bench {

double FrameShares::host_ms() const {
  double device = 0;
  for (const auto& stage : stages) device += stage.wall_ms();
  return frame_ms - device;
}

FrameShares BenchRecord::shares() const {
  FrameShares mean;
  if (profiled.empty()) return mean;
  const double scale = 1 / static_cast<double>(profiled.size());
  for (const auto& frame : profiled) {
    mean.frame_ms += frame.frame_ms * scale;
    for (const auto& stage : frame.stages) {
      std::size_t row = 0;
      while (row < mean.stages.size() && mean.stages[row].stage != stage.stage) ++row;
      if (row == mean.stages.size()) mean.stages.emplace_back().stage = stage.stage;
      mean.stages[row].kernel_ms += stage.kernel_ms * scale;
      mean.stages[row].transfer_ms += stage.transfer_ms * scale;
      mean.stages[row].queue_ms += stage.queue_ms * scale;
      mean.stages[row].launches += stage.launches * scale;
    }
  }
  return mean;
}

double BenchRecord::frame_ratio() const {
  return report::latency_summary(run.frames).median /
         report::median(yardsticks ? yardsticks->sift_both_ms : std::vector<double>());
}

double BenchRecord::edges_ratio() const {
  return report::median(edges_ms) / report::median(yardsticks ? yardsticks->sepfilter_nine_ms : std::vector<double>());
}

using report::Json;
using report::to_json;

namespace {

/// Every stage's times and its percentage of the frame; the host's rest last.
Json shares_json(const FrameShares& shares) {
  const auto percent = [&](double ms) { return to_json(100 * ms / shares.frame_ms); };
  Json json = {{"frame_ms", shares.frame_ms}, {"stages", Json::object()}};
  for (const auto& stage : shares.stages) {
    json["stages"][stage.stage] = {{"wall_ms", stage.wall_ms()},   {"percent", percent(stage.wall_ms())},
                                   {"kernel_ms", stage.kernel_ms}, {"transfer_ms", stage.transfer_ms},
                                   {"queue_ms", stage.queue_ms},   {"launches", stage.launches}};
  }
  json["host"] = {{"wall_ms", shares.host_ms()}, {"percent", percent(shares.host_ms())}};
  return json;
}

}  // namespace

std::string bench_json(const BenchRecord& record) {
  Json json = Json::parse(report::report_json(record.run));
  report::add_origin(json, record.command);
  json["bench_schema"] = kBenchSchema;
  json["frames_measured"] = record.run.frames.empty() ? 0 : static_cast<int>(record.run.frames.size()) - 1;
  json["warm_up"] = record.warm_up;
  json["threads"] = record.threads;
  json["edges_wanted"] = record.edges_wanted == 0 ? Json(nullptr) : Json(record.edges_wanted);
  json["edge_detection_ms"] = {{"median", to_json(report::median(record.edges_ms))},
                               {"p90", to_json(report::percentile(record.edges_ms, 0.9))}};
  json["waits_per_frame"] = record.waits;
  json["launches_per_frame"] = record.launches;
  json["writes_per_frame"] = record.writes;
  json["processor_ms"] = {{"median", to_json(report::median(record.processor_ms))},
                          {"p90", to_json(report::percentile(record.processor_ms, 0.9))}};
  if (!record.profiled.empty()) json["shares"] = shares_json(record.shares());
  json["moved_mb_per_frame"] = {{"to_device", record.to_device_mb}, {"to_host", record.to_host_mb}};
  json["memory_mb"]["frames"] = record.frames_mb;
  if (record.yardsticks) {
    json["baseline"] = {{"opencv_sift_both_ms", to_json(report::median(record.yardsticks->sift_both_ms))},
                        {"opencv_sepfilter_nine_ms", to_json(report::median(record.yardsticks->sepfilter_nine_ms))},
                        {"threads", record.yardsticks->threads},
                        {"frame_ratio", to_json(record.frame_ratio())},
                        {"edges_ratio", to_json(record.edges_ratio())}};
  }
  return report::json_text(json);
}

}  // namespace quadedge::bench
